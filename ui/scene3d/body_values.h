#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/estimation/body_model.h"

namespace skincal {

/// A number per module of BodyModel::modules, and the range over which colours are spread.
struct ModuleValues {
    std::vector<std::optional<double>> values;  ///< nothing where the body model has none
    double low = 0;
    double high = 1;  ///< above `low`; single values may lie beyond: the range holds 95 % of them

    /// 0 at `low`, 1 at `high`.
    [[nodiscard]] std::optional<double> share(std::size_t module) const;
};

/// Standard deviation of a module's position in its worst direction, mm, from its covariance.
[[nodiscard]] std::optional<double> worstSigma_mm(const BodyModule& module);

/// worstSigma_mm of all modules.
[[nodiscard]] ModuleValues uncertainties_mm(const BodyModel& body);

/// Root mean square of each module's residuals over the views that count, px.
[[nodiscard]] ModuleValues residuals_px(const BodyModel& body);

/// In how many views each module was found; range from 0 to the largest of them.
[[nodiscard]] ModuleValues viewCounts(const BodyModel& body);

/// The position in BodyModel::views of the last view that found each module; range from 0 to the last view.
[[nodiscard]] ModuleValues lastViews(const BodyModel& body);

/// Deviations from a surface (m, by module) as mm; the range is as wide to both sides of 0, and holds 95 % of them.
[[nodiscard]] ModuleValues deviations_mm(const BodyModel& body, const std::map<ModuleId, double>& deviations);

/// How much to enlarge ellipsoids of three standard deviations so that they can be seen and seldom meet: 1, 2 or 5
/// times a power of ten, never below 1.
[[nodiscard]] double ellipsoidScale(const BodyModel& body);

}  // namespace skincal
