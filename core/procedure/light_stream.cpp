#include "core/procedure/light_stream.h"

#include <algorithm>

namespace skincal {
namespace {

using Time = LightShow::Time;

/// Half a period early rather than half a period late: pictures are counted, not clocks.
Time dueAfter(const LightShow& show, const LightPlan& plan) {
    return show.commanded + plan.periods * plan.period - plan.period / 2;
}

}  // namespace

std::optional<std::size_t> showIn(std::span<const LightShow> shows, Time picture, Time now, const LightPlan& plan) {
    for (std::size_t i = 0; i < shows.size(); ++i) {
        if (!shows[i].acknowledged || picture < *shows[i].acknowledged + plan.from)
            continue;
        // What is lit later than the picture came is not in it, however that is dated.
        if (i + 1 == shows.size() || now <= shows[i + 1].commanded || picture < shows[i + 1].commanded + plan.until)
            return i;
    }
    return std::nullopt;
}

std::size_t showsOver(std::span<const LightShow> shows, Time picture, const LightPlan& plan) {
    std::size_t over = 0;
    while (over + 1 < shows.size() && picture >= shows[over + 1].commanded + plan.until)
        ++over;
    return over;
}

Time nextShowAt(std::span<const LightShow> shows, Time picture, Time earliest, const LightPlan& plan) {
    if (!shows.empty())
        earliest = std::max(earliest, dueAfter(shows.back(), plan));
    const Time onGrid = picture - plan.aim;
    Time ahead = (onGrid - earliest) % plan.period;
    if (ahead.count() < 0)
        ahead += plan.period;
    return earliest + ahead;
}

bool isNextShowDue(std::span<const LightShow> shows, Time now, const LightPlan& plan) {
    return shows.empty() || now >= dueAfter(shows.back(), plan);
}

}  // namespace skincal
