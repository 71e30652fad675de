#include "core/procedure/stillness.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

#include "core/geometry/se3.h"

namespace skincal {
namespace {

/// Samples that a window holds, however slowly they come.
constexpr std::size_t kFewest = 3;

/// Sums of one module's readings.
struct Moments {
    int count = 0;
    Vector3d sum = Vector3d::Zero();
    double squares = 0;

    void add(const Vector3d& a) {
        ++count;
        sum += a;
        squares += a.squaredNorm();
    }
    /// Per axis.
    [[nodiscard]] double variance() const {
        const double n = count;
        return std::max(0.0, (squares - sum.squaredNorm() / n) / (3 * (n - 1)));
    }
};

}  // namespace

StillnessMeter::StillnessMeter(std::vector<ModuleId> modules, const StillnessOptions& options)
    : modules_(std::move(modules)), options_(options) {
    if (!options.validate())
        throw std::logic_error("StillnessOptions out of range");
}

void StillnessMeter::add(std::chrono::microseconds time, std::span<const std::optional<Vector3d>> acceleration) {
    if (acceleration.size() != modules_.size())
        throw std::logic_error("a sample has one entry per module");
    if (!samples_.empty() && time <= samples_.back().time)
        clear();  // the device's clock began anew
    samples_.push_back({time, {acceleration.begin(), acceleration.end()}});
    while (samples_.size() > kFewest && samples_.front().time < time - kKept)
        samples_.pop_front();
}

std::chrono::microseconds StillnessMeter::period() const {
    if (samples_.size() < kFewest)
        return {};
    auto shortest = std::chrono::microseconds::max();
    for (std::size_t i = samples_.size() + 1 - kFewest; i < samples_.size(); ++i)
        shortest = std::min(shortest, samples_[i].time - samples_[i - 1].time);
    return shortest;
}

std::chrono::microseconds StillnessMeter::window() const {
    // They come a little early or late.
    return std::max<std::chrono::microseconds>(options_.window, (kFewest - 1) * period() * 5 / 4);
}

void StillnessMeter::clear() {
    samples_.clear();
}

std::optional<double> StillnessMeter::movement() const {
    if (samples_.empty())
        return std::nullopt;
    const auto newest = samples_.back().time;
    const auto length = window();
    const auto oldest = std::find_if(samples_.begin(), samples_.end(),
                                     [&](const Sample& sample) { return sample.time >= newest - length; });
    if (newest - oldest->time < length / 2)
        return std::nullopt;
    std::vector<Moments> moments(modules_.size());
    for (auto sample = oldest; sample != samples_.end(); ++sample) {
        for (std::size_t u = 0; u < modules_.size(); ++u) {
            if (sample->acceleration[u])
                moments[u].add(*sample->acceleration[u]);
        }
    }
    double sum = 0;
    int count = 0;
    for (const Moments& of : moments) {
        if (of.count < 2)
            continue;
        sum += of.variance();
        ++count;
    }
    if (count == 0)
        return std::nullopt;
    return std::sqrt(sum / count);
}

bool StillnessMeter::isAtRest() const {
    const auto moves = movement();
    return moves && *moves < options_.restsBelow;
}

std::vector<GravityReading> StillnessMeter::meansSince(std::chrono::microseconds from, int pose) const {
    std::vector<GravityReading> readings;
    for (std::size_t u = 0; u < modules_.size(); ++u) {
        Moments of;
        for (const Sample& sample : samples_) {
            if (sample.time >= from && sample.acceleration[u])
                of.add(*sample.acceleration[u]);
        }
        if (of.count < 2)
            continue;
        const double n = of.count;
        const double sigma = std::sqrt(of.variance() / n);
        readings.push_back(
            {pose, modules_[u], of.sum / n, sigma < kSmallestSigma ? std::nullopt : std::optional(sigma), of.count});
    }
    return readings;
}

double angleToNearestPose(std::span<const GravityReading> captured, std::span<const GravityReading> now) {
    std::vector<std::pair<ModuleId, Vector3d>> current;
    for (const GravityReading& reading : now) {
        if (reading.acceleration.norm() > 0)
            current.emplace_back(reading.module, reading.acceleration.normalized());
    }
    const auto byId = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::stable_sort(current.begin(), current.end(), byId);
    std::map<int, std::vector<double>> cosines;
    for (const GravityReading& reading : captured) {
        const auto found =
            std::lower_bound(current.begin(), current.end(), std::pair{reading.module, Vector3d()}, byId);
        if (found != current.end() && found->first == reading.module && reading.acceleration.norm() > 0)
            cosines[reading.pose].push_back(reading.acceleration.normalized().dot(found->second));
    }
    double nearest = 180 * kDegree;
    for (auto& [pose, of] : cosines) {
        const auto middle = of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2);
        std::nth_element(of.begin(), middle, of.end(), std::greater<>());
        nearest = std::min(nearest, std::acos(std::clamp(*middle, -1.0, 1.0)));
    }
    return nearest;
}

}  // namespace skincal
