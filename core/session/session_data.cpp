#include "core/session/session_data.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "core/vision/verdicts.h"

namespace skincal {
namespace {

bool sameDecision(const std::pair<const DetectionKey, Decision>& a, const std::pair<const DetectionKey, Decision>& b) {
    return a.first == b.first && a.second.verdict == b.second.verdict && a.second.reason == b.second.reason;
}

Skin decidedSkin(const Measured& measured, const Decisions& decisions) {
    Skin skin = measured.skin;
    for (Link& link : skin.links) {
        const auto decided = decisions.links.find(LinkKey::of(link));
        if (decided != decisions.links.end())
            link.decided = decided->second;
    }
    return skin;
}

std::vector<GravityReading> countingReadings(const Measured& measured, const Decisions& decisions) {
    std::vector<GravityReading> readings;
    for (const GravityReading& reading : measured.gravity) {
        if (!decisions.droppedPoses.contains(reading.pose))
            readings.push_back(reading);
    }
    return readings;
}

/// A rejected detection counts as not found, and so do several spots of which none was sure.
ViewDetections withoutRejected(ViewDetections view, const Decisions& decisions) {
    const auto whyRejected = [&](ModuleId module) -> std::optional<Sentence> {
        const auto decision = decisions.detections.find({view.name, module});
        if (decision == decisions.detections.end() || decision->second.verdict != "rejected")
            return std::nullopt;
        const std::string& why = decision->second.reason;
        return rejectedByOperator(why);
    };
    for (Undetected& undetected : view.undetected) {
        const auto why = undetected.spots.empty() ? std::nullopt : whyRejected(undetected.module);
        if (why)
            undetected = {undetected.module, DetectionVerdict::NotFound, *why, {}, Undetected::Cause::Rejected};
    }
    std::erase_if(view.found, [&](const LedDetection& detection) {
        const auto why = whyRejected(detection.module);
        if (why)
            view.undetected.push_back(
                {detection.module, DetectionVerdict::NotFound, *why, {}, Undetected::Cause::Rejected});
        return why.has_value();
    });
    return view;
}

}  // namespace

bool sameCamera(const std::optional<CameraModel>& a, const std::optional<CameraModel>& b) {
    if (!a || !b)
        return a.has_value() == b.has_value();
    const auto tie = [](const CameraModel& c) {
        return std::tie(c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.distortionModel, c.distortion);
    };
    return tie(*a) == tie(*b);
}

LinkKey LinkKey::of(const Link& link) {
    if (std::tie(link.b, link.b_port) < std::tie(link.a, link.a_port))
        return {link.b, link.b_port, link.a, link.a_port};
    return {link.a, link.a_port, link.b, link.b_port};
}

bool Decisions::operator==(const Decisions& other) const {
    return links == other.links && droppedPoses == other.droppedPoses && droppedViews == other.droppedViews &&
           std::equal(detections.begin(), detections.end(), other.detections.begin(), other.detections.end(),
                      sameDecision) &&
           sameCamera(camera, other.camera) && cameraOrigin == other.cameraOrigin;
}

Measurements measurementsOf(const Measured& measured, const Decisions& decisions) {
    Measurements result{decidedSkin(measured, decisions), countingReadings(measured, decisions), {}, {}};
    if (!decisions.camera)
        return result;
    result.camera = *decisions.camera;
    for (const ScannedView& view : measured.views) {
        if (!decisions.droppedViews.contains(view.name))
            result.views.push_back(withoutRejected(view.decoded, decisions));
    }
    return result;
}

Recording recordingOf(const Measured& measured, const Decisions& decisions) {
    Recording recording;
    recording.skin = decidedSkin(measured, decisions);
    recording.gravity = countingReadings(measured, decisions);
    if (decisions.camera) {
        recording.camera = *decisions.camera;
        recording.cameraOrigin = decisions.cameraOrigin;
    }
    for (const ScannedView& view : measured.views) {
        // Without a camera pictures mean nothing.
        if (decisions.droppedViews.contains(view.name) || !decisions.camera)
            continue;
        RecordedView recorded{view.name, view.frames, {}};
        if (view.frames.empty())
            recorded.detections = view.decoded.found;
        recording.views.push_back(std::move(recorded));
    }
    for (const auto& [key, decision] : decisions.detections) {
        if (decisions.camera && !decisions.droppedViews.contains(key.view))
            recording.decisions.push_back(decision);
    }
    recording.unknown = measured.unknown;
    recording.unknownOfTypes = measured.unknownOfTypes;
    return recording;
}

OpenedRecording openedFrom(const Recording& recording) {
    OpenedRecording opened;
    opened.measured.skin = recording.skin;
    for (Link& link : opened.measured.skin.links) {
        if (link.decided)
            opened.decisions.links[LinkKey::of(link)] = *link.decided;
        link.decided.reset();
    }
    opened.measured.gravity = recording.gravity;
    opened.measured.unknown = recording.unknown;
    opened.measured.unknownOfTypes = recording.unknownOfTypes;
    for (const RecordedView& view : recording.views)
        opened.measured.views.push_back({view.name, view.frames, nullptr, {view.name, view.detections, {}}});
    for (const Decision& decision : recording.decisions)
        opened.decisions.detections[{decision.view, decision.module}] = decision;
    if (recording.camera.width > 0) {
        opened.decisions.camera = recording.camera;
        opened.decisions.cameraOrigin = recording.cameraOrigin;
    }
    return opened;
}

std::vector<int> posesOf(const Measured& measured, const Decisions& decisions) {
    std::set<int> poses;
    for (const GravityReading& reading : measured.gravity) {
        if (!decisions.droppedPoses.contains(reading.pose))
            poses.insert(reading.pose);
    }
    return {poses.begin(), poses.end()};
}

std::optional<Skin> sameSkin(const Skin& before, const Skin& now) {
    std::map<ModuleId, std::string> present;
    bool isKnown = false;
    for (const SkinModule& module : now.modules)
        present.emplace(module.id, module.uniqueId);
    std::vector<SkinModule> missing;
    for (const SkinModule& module : before.modules) {
        const auto found = present.find(module.id);
        if (found == present.end())
            missing.push_back(module);
        else if (found->second != module.uniqueId)
            return std::nullopt;  // another module under this number
        else
            isKnown = isKnown || !module.uniqueId.empty();
    }
    if (missing.empty() && before.modules.size() == now.modules.size())
        return now;
    if (!isKnown)
        return std::nullopt;
    Skin joined = now;
    std::set<ModuleId> gone;
    for (const SkinModule& module : missing) {
        const ModuleTemplate& type = before.templates[module.type];
        const auto known = std::find_if(joined.templates.begin(), joined.templates.end(),
                                        [&](const ModuleTemplate& t) { return t.name == type.name; });
        const auto place = static_cast<std::size_t>(known - joined.templates.begin());
        if (known == joined.templates.end())
            joined.templates.push_back(type);
        joined.modules.push_back({module.id, place, module.uniqueId});
        gone.insert(module.id);
    }
    for (const Link& link : before.links)
        if (gone.contains(link.a) || gone.contains(link.b))
            joined.links.push_back(link);
    return joined;
}

}  // namespace skincal
