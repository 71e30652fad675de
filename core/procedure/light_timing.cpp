#include "core/procedure/light_timing.h"

#include <algorithm>
#include <stdexcept>

namespace skincal {
namespace {

using Time = LightTiming::Time;

/// Between which bounds the toggles, each for itself, have something: (after, until].
struct Bounds {
    std::vector<Time> after;
    std::vector<Time> until;

    [[nodiscard]] Time greatestAfter() const { return *std::max_element(after.begin(), after.end()); }
    [[nodiscard]] Time leastUntil() const { return *std::min_element(until.begin(), until.end()); }
    [[nodiscard]] Time contradiction() const { return std::max(greatestAfter() - leastUntil(), Time{}); }
};

std::vector<Time> stepsBetween(std::span<const LightToggle> toggles) {
    std::vector<Time> steps;
    for (const LightToggle& toggle : toggles) {
        for (std::size_t i = 1; i < toggle.pictures.size(); ++i) {
            steps.push_back(toggle.pictures[i].time - toggle.pictures[i - 1].time);
            if (steps.back().count() <= 0)
                throw std::logic_error("LightToggle: times of pictures don't rise");
        }
    }
    return steps;
}

Time upperMedian(std::vector<Time> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// How far pictures come from whole periods after each other.
Time unsteadiness(const std::vector<Time>& steps, Time period) {
    Time worst{};
    for (const Time step : steps) {
        const Time off = step % period;
        worst = std::max(worst, std::min(off, period - off));
    }
    return worst;
}

}  // namespace

tl::expected<LightTiming, LightTimingError> estimateLightTiming(std::span<const LightToggle> toggles,
                                                                const LightTimingOptions& options) {
    if (!options.validate())
        throw std::logic_error("LightTimingOptions out of range");
    if (toggles.size() < 2)
        throw std::logic_error("one toggle does not time the light");
    LightTiming timing;
    Bounds all;
    Bounds none;
    for (const LightToggle& toggle : toggles) {
        const auto& pictures = toggle.pictures;
        if (pictures.size() < 3 || toggle.acknowledged < toggle.commanded)
            throw std::logic_error("LightToggle is not complete");
        const auto isWhole = [&](const LightToggle::Picture& p) { return p.share >= options.whole; };
        const auto isTouched = [&](const LightToggle::Picture& p) { return p.share > 1 - options.whole; };
        const auto touched = std::find_if(pictures.begin(), pictures.end(), isTouched);
        const auto whole = std::find_if_not(pictures.rbegin(), pictures.rend(), isWhole).base();
        if (touched == pictures.begin() || touched == pictures.end() || whole == pictures.end())
            return tl::unexpected(LightTimingError::NoChange);
        all.after.push_back(std::prev(whole)->time - toggle.acknowledged);
        all.until.push_back(whole->time - toggle.commanded);
        none.after.push_back(std::prev(touched)->time - toggle.acknowledged);
        none.until.push_back(touched->time - toggle.commanded);
        timing.answer = std::max(timing.answer, toggle.acknowledged - toggle.commanded);
    }
    const std::vector<Time> steps = stepsBetween(toggles);
    timing.period = upperMedian(steps);
    timing.jitter = std::max({all.contradiction(), none.contradiction(), unsteadiness(steps, timing.period)});
    if (timing.jitter > options.maxJitter)
        return tl::unexpected(LightTimingError::TooJittery);
    timing.latency = (all.greatestAfter() + all.leastUntil()) / 2;
    timing.uncertainty = std::chrono::abs(all.leastUntil() - all.greatestAfter()) / 2;
    // The least bound that no toggle contradicts. There is one: that of the toggle that was latest.
    timing.newFrom = Time::max();
    for (const Time until : all.until) {
        if (until >= all.greatestAfter())
            timing.newFrom = std::min(timing.newFrom, until);
    }
    timing.oldUntil = Time::min();
    for (const Time after : none.after) {
        if (after <= none.leastUntil())
            timing.oldUntil = std::max(timing.oldUntil, after);
    }
    return timing;
}

std::optional<LightPlan> planLights(const LightTiming& timing, bool keepsTime, const LightTimingOptions& options) {
    if (!options.validate())
        throw std::logic_error("LightTimingOptions out of range");
    const Time least = std::max(options.minMargin, 2 * timing.jitter);
    for (int periods = options.minPeriods; periods <= options.maxPeriods; ++periods) {
        const Time shown = periods * timing.period;
        const Time slack = shown - timing.answer - (timing.newFrom - timing.oldUntil);
        const Time margin = keepsTime ? slack / 4 : (slack - timing.period) / 2;
        if (margin < least)
            continue;
        LightPlan plan;
        plan.period = timing.period;
        plan.periods = periods;
        plan.from = timing.newFrom + margin;
        plan.until = timing.oldUntil - margin;
        plan.aim = (timing.answer + timing.newFrom + shown + timing.oldUntil) / 2;
        return plan;
    }
    return std::nullopt;
}

}  // namespace skincal
