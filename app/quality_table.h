#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/estimation/body_model.h"

namespace skincal {

/// The figures a person needs to trust or refuse a body, as a table of plain text.
[[nodiscard]] std::string qualityTable(const BodyModel& body);

/// The same for scripts.
[[nodiscard]] nlohmann::ordered_json qualityJson(const BodyModel& body);

}  // namespace skincal
