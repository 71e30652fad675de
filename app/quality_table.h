#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/estimation/body_model.h"

namespace skincal {

/// A line of the table: what, and its value, which is not wrapped.
using TableRow = std::pair<std::string, std::string>;

/// The figures a person needs to trust or refuse a body, as plain text at most 100 columns wide: patches, figures,
/// `more`, then what was found wrong, what is missing and what to beware of, each once.
[[nodiscard]] std::string qualityTable(const BodyModel& body, const std::vector<TableRow>& more = {});

/// The same for scripts.
[[nodiscard]] nlohmann::ordered_json qualityJson(const BodyModel& body);

/// What the computation took, one entry for each stage however often it ran.
[[nodiscard]] std::vector<StageReport> sumByStage(const std::vector<StageReport>& stages);

/// All of it together.
[[nodiscard]] StageReport total(const std::vector<StageReport>& stages);

/// Placed modules that no picture shows.
[[nodiscard]] std::size_t restingOnLinksAndGravity(const BodyModel& body);

}  // namespace skincal
