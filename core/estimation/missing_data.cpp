#include "core/estimation/missing_data.h"

#include <algorithm>

#include "core/estimation/advice_basis.h"

namespace skincal {
namespace {

Sentence leds(std::size_t count) {
    return count == 1 ? Sentence::saying("1 LED") : Sentence::saying("{} LEDs", count);
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

Sentence whyNotPlaced(const Skin& skin, const Patch& patch, const PatchEvidence& evidence, int needed, bool anyPlaced) {
    const Sentence who = Sentence::saying("patch {} (origin {})", patch.id.value, skin.modules[patch.origin].id.value);
    switch (reasonNotPlaced(patch, evidence, needed, anyPlaced)) {
        case NotPlaced::Unseen:
            return anyPlaced
                       ? Sentence::saying("{} was seen in no view: add one that shows it beside a placed patch", who)
                       : Sentence::saying("{} was seen in no view: add one that shows it", who);
        case NotPlaced::ShapeUnknown:
            return Sentence::saying(
                "{} showed {} in a view, but {} of their modules have gravity readings that tell how they lie: read "
                "their accelerometers in two poses or more that tilt the body differently",
                who, leds(evidence.mostDetected),
                evidence.mostUsable == 0 ? Sentence::saying("none") : Sentence::saying("only {}", evidence.mostUsable));
        case NotPlaced::TooSmall:
            return Sentence::saying(
                "{} has {} of the {} LEDs that a pose takes: show it in two views or more in which other patches are "
                "placed",
                who, patch.modules.size(), needed);
        case NotPlaced::TooFewLeds:
            return Sentence::saying(
                "{} showed at most {} in a view, {} are needed: move the camera closer or more in front of it", who,
                leds(evidence.mostUsable), needed);
        case NotPlaced::OnALine:
            return Sentence::saying(
                "{} showed only LEDs in one line, which have no pose: add a view that shows more of it", who);
        case NotPlaced::Contradicted:
            return Sentence::saying(
                "{} is nowhere where its shape explains the LEDs: its links, module types or detections are wrong",
                who);
        case NotPlaced::TwoPlaces:
            return Sentence::saying("{} could be in two places in each view: add one that shows it more from the side",
                                    who);
        default:
            return Sentence::saying("{} was never seen with a placed patch: add a view that shows both", who);
    }
}

Sentence whyNotHeld(const Skin& skin, const std::vector<std::size_t>& modules) {
    if (modules.empty())
        return {};
    std::vector<ModuleId> ids;
    for (const std::size_t u : modules)
        ids.push_back(skin.modules[u].id);
    if (ids.size() == 1)
        return Sentence::saying(
            "{}: no gravity readings tell how it lies, and links and pictures do not hold it: read its accelerometer "
            "in "
            "two poses or more that tilt the body differently",
            listed(ids));
    return Sentence::saying(
        "{}: no gravity readings tell how they lie, and links and pictures do not hold them: read their "
        "accelerometers in two poses or more that tilt the body differently",
        listed(ids));
}

}  // namespace skincal
