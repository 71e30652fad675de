#include "ui/presenters/tactile_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skincal {
namespace {

constexpr float kHeight = 0.012F;      // m, of a board whose value is at the upper end
constexpr double kContactForce = 0.1;  // N, well above the noise of three cells
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

const ModuleTemplate* typeOf(const BodyModel& body, const BodyModule& module) {
    const auto found = std::find_if(body.templates.begin(), body.templates.end(),
                                    [&](const ModuleTemplate& type) { return type.name == module.type; });
    return found == body.templates.end() ? nullptr : &*found;
}

/// Module frame; the middle of the board where the template doesn't say where its cells are.
Vector3d pressedAt(const FeltModule& felt, const ModuleTemplate* type) {
    Vector3d sum = Vector3d::Zero();
    double force = 0;
    std::size_t cell = 0;
    if (type != nullptr) {
        for (const SensorSite& sensor : type->sensors) {
            if (sensor.kind != "force" || cell == felt.cells.size())
                continue;
            const double own = static_cast<double>(static_cast<float>(felt.cells.at(cell++)));
            sum += own * sensor.position;
            force += own;
        }
    }
    return force > 0 ? Vector3d(sum / force) : Vector3d::Zero();
}

}  // namespace

QuantityRange rangeOf(Quantity quantity) {
    switch (quantity) {
        case Quantity::Proximity:
            return {0, 1, 0};
        case Quantity::Force:
            return {0, 5, 0};
        case Quantity::Temperature:
            return {22, 34, 26};
        case Quantity::Acceleration:
            return {5, 15, 15};
    }
    return {};
}

float valueOf(const FeltModule& felt, Quantity quantity) {
    switch (quantity) {
        case Quantity::Proximity:
            return static_cast<float>(felt.proximity);
        case Quantity::Force:
            return felt.force();
        case Quantity::Temperature:
            return static_cast<float>(felt.temperature);
        case Quantity::Acceleration:
            return static_cast<float>(felt.acceleration);
    }
    return kUnknown;
}

void drawPicture(TactilePicture& picture, std::span<const FeltModule> felt, Quantity quantity, const BodyModel& body) {
    const QuantityRange range = rangeOf(quantity);
    const auto low = static_cast<float>(range.low);
    const auto rest = static_cast<float>(range.rest);
    const float scale = 1 / static_cast<float>(range.high - range.low);
    const float rise = range.high > range.rest ? kHeight / static_cast<float>(range.high - range.rest) : 0.0F;
    const std::size_t count = std::min(felt.size(), body.modules.size());
    picture.values.assign(body.modules.size(), kUnknown);
    picture.heights.assign(body.modules.size(), 0.0F);
    picture.contacts.clear();
    const auto isStronger = [](const TouchContact& a, const TouchContact& b) { return a.force > b.force; };
    for (std::size_t u = 0; u < count; ++u) {
        if (!felt[u].isKnown())
            continue;
        const float value = valueOf(felt[u], quantity);
        picture.values[u] = std::clamp((value - low) * scale, 0.0F, 1.0F);
        picture.heights[u] = std::clamp((value - rest) * rise, 0.0F, kHeight);
        TouchContact contact{body.modules[u].id, static_cast<double>(felt[u].force())};
        if (contact.force < kContactForce ||
            (picture.contacts.size() == kMostContacts && !isStronger(contact, picture.contacts.back())))
            continue;
        if (picture.contacts.size() == kMostContacts)
            picture.contacts.pop_back();
        if (const auto& T_r_u = body.modules[u].T_body_module) {
            contact.position_r = *T_r_u * pressedAt(felt[u], typeOf(body, body.modules[u]));
            contact.normal_r = T_r_u->linear().col(2);
        }
        picture.contacts.insert(std::upper_bound(picture.contacts.begin(), picture.contacts.end(), contact, isStronger),
                                contact);
    }
}

void drawTrace(Trace& trace, const TactileHistory& history, Quantity quantity, std::size_t whiles) {
    trace.ranges.assign(whiles, {kUnknown, kUnknown});
    const auto module = history.indexOf(trace.module);
    if (!module || history.size() == 0 || whiles == 0)
        return;
    const auto length = TactileHistory::kSpan / static_cast<TactileHistory::Time::rep>(whiles);
    const auto last = history.timeOf(history.size() - 1) / length;
    for (std::size_t i = 0; i < history.size(); ++i) {
        const auto back = last - history.timeOf(i) / length;
        const float value = valueOf(history.at(i)[*module], quantity);
        if (back < 0 || back >= static_cast<std::int64_t>(whiles) || std::isnan(value))
            continue;
        auto& [least, most] = trace.ranges[whiles - 1 - static_cast<std::size_t>(back)];
        least = std::isnan(least) ? value : std::min(least, value);
        most = std::isnan(most) ? value : std::max(most, value);
    }
}

}  // namespace skincal
