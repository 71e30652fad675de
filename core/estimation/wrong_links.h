#pragma once

#include <optional>
#include <utility>

#include "core/estimation/body_solution.h"

namespace skincal {

/// "the link from module 3 port 1 to module 17 port 0"
[[nodiscard]] Sentence inWords(const Skin& skin, const GraphLink& link);

/// That other ports of its modules meet than those that a link was reported between.
[[nodiscard]] Sentence reportedWrongly(const BodySolution& solution, const GraphLink& link,
                                       const std::pair<std::size_t, std::size_t>& meet);

/// Which ports of a link's modules come out nearest to each other, within `limit` (m).
[[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> portsThatMeet(const BodySolution& solution,
                                                                               const GraphLink& link, double limit);

/// How far apart the ports of a link came out, m. Both modules must have a pose.
[[nodiscard]] double gapOf(const BodySolution& solution, const GraphLink& link);

/// Names the links that were taken for cables though other ports of the same modules meet in the solution: they are
/// reported wrongly. @param limit  m, how near ports are that meet.
void nameMisportedLinks(BodySolution& solution, double limit);

}  // namespace skincal
