#include "ui/scene3d/body_values.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace skincal {
namespace {

/// To two digits.
double rounded(double value, double (*to)(double)) {
    if (value <= 0)
        return 0;
    const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
    return to(value / unit) * unit;
}

double quantile(std::vector<double> values, double share) {
    const auto at = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

std::vector<double> known(const std::vector<std::optional<double>>& values) {
    std::vector<double> all;
    for (const std::optional<double>& value : values) {
        if (value && std::isfinite(*value))
            all.push_back(*value);
    }
    return all;
}

/// Colours are spread from the least to what holds 95 %: one module far worse than all others hides nothing.
ModuleValues withRange(std::vector<std::optional<double>> values) {
    ModuleValues result{std::move(values), 0, 1};
    const std::vector<double> all = known(result.values);
    if (all.empty())
        return result;
    result.low = rounded(*std::min_element(all.begin(), all.end()), std::floor);
    result.high = rounded(quantile(all, 0.95), std::ceil);
    // Where all are alike, colours that differ would make much of nothing.
    if (result.high < 1.2 * result.low)
        result.low = 0;
    if (result.high <= result.low)
        result.high = result.low + 1;
    return result;
}

/// Calls found(module index, view index, observation) for each LED found in a view that has a pose.
template <class Function>
void forEachSighting(const BodyModel& body, Function&& found) {
    std::unordered_map<ModuleId, std::size_t> index;
    for (std::size_t i = 0; i < body.modules.size(); ++i)
        index[body.modules[i].id] = i;
    for (std::size_t v = 0; v < body.views.size(); ++v) {
        for (const BodyObservation& observation : body.views[v].observations) {
            const auto module = index.find(observation.module);
            if (module != index.end() && observation.verdict == ObservationVerdict::Used)
                found(module->second, v, observation);
        }
    }
}

}  // namespace

std::optional<double> ModuleValues::share(std::size_t module) const {
    if (!values[module])
        return std::nullopt;
    return std::clamp((*values[module] - low) / (high - low), 0.0, 1.0);
}

std::optional<double> worstSigma_mm(const BodyModule& module) {
    if (!module.covariance)
        return std::nullopt;
    const Matrix3d position = module.covariance->bottomRightCorner<3, 3>();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(position, Eigen::EigenvaluesOnly);
    return 1e3 * std::sqrt(std::max(0.0, axes.eigenvalues()[2]));
}

ModuleValues uncertainties_mm(const BodyModel& body) {
    std::vector<std::optional<double>> values;
    values.reserve(body.modules.size());
    for (const BodyModule& module : body.modules)
        values.push_back(worstSigma_mm(module));
    return withRange(std::move(values));
}

ModuleValues residuals_px(const BodyModel& body) {
    std::vector<double> sum(body.modules.size(), 0);
    std::vector<int> count(body.modules.size(), 0);
    forEachSighting(body, [&](std::size_t module, std::size_t /*view*/, const BodyObservation& observation) {
        if (observation.residual) {
            sum[module] += observation.residual->squaredNorm();
            ++count[module];
        }
    });
    std::vector<std::optional<double>> values(body.modules.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (count[i] > 0)
            values[i] = std::sqrt(sum[i] / count[i]);
    }
    return withRange(std::move(values));
}

ModuleValues viewCounts(const BodyModel& body) {
    ModuleValues result{std::vector<std::optional<double>>(body.modules.size(), 0.0), 0, 1};
    forEachSighting(body, [&](std::size_t module, std::size_t /*view*/, const BodyObservation& /*observation*/) {
        result.values[module] = *result.values[module] + 1;
        result.high = std::max(result.high, *result.values[module]);
    });
    return result;
}

ModuleValues lastViews(const BodyModel& body) {
    ModuleValues result{std::vector<std::optional<double>>(body.modules.size()), 0,
                        std::max(1.0, static_cast<double>(body.views.size()) - 1)};
    forEachSighting(body, [&](std::size_t module, std::size_t view, const BodyObservation& /*observation*/) {
        result.values[module] = static_cast<double>(view);
    });
    return result;
}

ModuleValues deviations_mm(const BodyModel& body, const std::map<ModuleId, double>& deviations) {
    ModuleValues result{std::vector<std::optional<double>>(body.modules.size()), -1, 1};
    std::vector<double> sizes;
    for (std::size_t i = 0; i < body.modules.size(); ++i) {
        const auto found = deviations.find(body.modules[i].id);
        if (found == deviations.end())
            continue;
        result.values[i] = 1e3 * found->second;
        sizes.push_back(std::abs(1e3 * found->second));
    }
    if (sizes.empty())
        return result;
    // Colours of a micrometre would make much of nothing.
    constexpr double kLeast_mm = 0.1;
    result.high = std::max(kLeast_mm, rounded(quantile(std::move(sizes), 0.95), std::ceil));
    result.low = -result.high;
    return result;
}

double ellipsoidScale(const BodyModel& body) {
    std::vector<double> sigmas;
    double board = 0;
    for (const BodyModule& module : body.modules) {
        if (const auto sigma = worstSigma_mm(module); sigma && *sigma > 0 && module.T_body_module)
            sigmas.push_back(*sigma * 1e-3);
    }
    for (const ModuleTemplate& type : body.templates)
        board = std::max(board, type.portRadius());
    if (sigmas.empty() || board <= 0)
        return 1;
    const double wanted = 1.1 * board / (3 * quantile(sigmas, 0.9));
    const double power = std::pow(10, std::floor(std::log10(std::max(1.0, wanted))));
    const double digit = wanted / power;
    return std::max(1.0, power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1));
}

}  // namespace skincal
