#include "core/estimation/missing_data.h"

#include <fmt/format.h>

#include <algorithm>

namespace skincal {
namespace {

std::string leds(std::size_t count) {
    return fmt::format("{} LED{}", count, count == 1 ? "" : "s");
}

}  // namespace

std::vector<PatchEvidence> patchEvidence(const SkinLayout& layout, const std::vector<PatchShape>& shapes,
                                         const std::vector<PixelObservation>& pixels) {
    std::vector<bool> hasPlace(layout.patchOf.size(), false);
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        for (std::size_t i = 0; i < layout.patches[k].modules.size(); ++i)
            hasPlace[layout.patches[k].modules[i]] = shapes[k].T_o_u[i].has_value();
    }
    struct Count {
        std::size_t detected = 0, usable = 0;
    };
    std::map<std::pair<std::size_t, std::size_t>, Count> counts;  // by patch and view
    for (const PixelObservation& o : pixels) {
        Count& count = counts[{layout.patchOf[o.module], o.view}];
        ++count.detected;
        count.usable += hasPlace[o.module] ? 1 : 0;
    }
    std::vector<PatchEvidence> evidence(layout.patches.size());
    for (const auto& [where, count] : counts) {
        PatchEvidence& patch = evidence[where.first];
        patch.mostDetected = std::max(patch.mostDetected, count.detected);
        patch.mostUsable = std::max(patch.mostUsable, count.usable);
    }
    return evidence;
}

NotPlaced reasonNotPlaced(const Patch& patch, const PatchEvidence& evidence, int needed, bool anyPlaced) {
    const auto enough = static_cast<std::size_t>(needed);
    if (evidence.mostDetected == 0)
        return NotPlaced::Unseen;
    if (evidence.mostUsable < enough && evidence.mostDetected > evidence.mostUsable)
        return NotPlaced::ShapeUnknown;
    if (patch.modules.size() < enough)
        return NotPlaced::TooSmall;
    if (evidence.mostUsable < enough)
        return NotPlaced::TooFewLeds;
    const auto commonest = std::max_element(evidence.poseFailures.begin(), evidence.poseFailures.end(),
                                            [](const auto& a, const auto& b) { return a.second < b.second; });
    if (commonest != evidence.poseFailures.end() && commonest->first == ErrorCode::DegeneratePoints)
        return NotPlaced::OnALine;
    if (commonest != evidence.poseFailures.end() && commonest->first == ErrorCode::NoConsensus)
        return NotPlaced::Contradicted;
    return anyPlaced ? NotPlaced::NeverWithPlaced : NotPlaced::TwoPlaces;
}

std::string whyNotPlaced(const Skin& skin, const Patch& patch, const PatchEvidence& evidence, int needed,
                         bool anyPlaced) {
    const std::string who = fmt::format("patch {} (origin {})", patch.id.value, skin.modules[patch.origin].id.value);
    switch (reasonNotPlaced(patch, evidence, needed, anyPlaced)) {
        case NotPlaced::Unseen:
            return who + " was seen in no view: add one that shows it" + (anyPlaced ? " beside a placed patch" : "");
        case NotPlaced::ShapeUnknown:
            return fmt::format(
                "{} showed {} in a view, but {} of their modules have gravity readings that tell how they lie: read "
                "their accelerometers in two poses or more that tilt the body differently",
                who, leds(evidence.mostDetected),
                evidence.mostUsable == 0 ? "none" : fmt::format("only {}", evidence.mostUsable));
        case NotPlaced::TooSmall:
            return fmt::format(
                "{} has {} of the {} LEDs that a pose takes: show it in two views or more in which other patches are "
                "placed",
                who, patch.modules.size(), needed);
        case NotPlaced::TooFewLeds:
            return fmt::format(
                "{} showed at most {} in a view, {} are needed: move the camera closer or more in front of it", who,
                leds(evidence.mostUsable), needed);
        case NotPlaced::OnALine:
            return who + " showed only LEDs in one line, which have no pose: add a view that shows more of it";
        case NotPlaced::Contradicted:
            return who +
                   " is nowhere where its shape explains the LEDs: its links, module types or detections are wrong";
        case NotPlaced::TwoPlaces:
            return who + " could be in two places in each view: add one that shows it more from the side";
        default:
            return who + " was never seen with a placed patch: add a view that shows both";
    }
}

std::string whyNotHeld(const Skin& skin, const std::vector<std::size_t>& modules) {
    if (modules.empty())
        return "";
    constexpr std::size_t kNamed = 8;
    std::string names;
    for (std::size_t i = 0; i < std::min(kNamed, modules.size()); ++i)
        names += (i == 0 ? "" : ", ") + std::to_string(skin.modules[modules[i]].id.value);
    if (modules.size() > kNamed)
        names += fmt::format(" and {} more", modules.size() - kNamed);
    return fmt::format(
        "modules {}: no gravity readings tell how they lie, and links and pictures do not hold them: read their "
        "accelerometers in two poses or more that tilt the body differently",
        names);
}

}  // namespace skincal
