#pragma once

#include <compare>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/adjustment/measurements.h"
#include "core/formats/recording.h"

namespace skincal {

using Pictures = std::vector<cv::Mat>;

/// One scan: what was lit in which picture, and what the decoder made of it.
struct ScannedView {
    std::string name;
    std::vector<FrameInfo> frames;             ///< empty where only detections were recorded
    std::shared_ptr<const Pictures> pictures;  ///< of `frames`; null where they are on the disk alone
    ViewDetections decoded;                    ///< before anybody rejected anything
    /// What was noticed beside that; empty where it was not scanned here.
    struct Scan {
        double moved_px = 0;    ///< the camera, meanwhile
        std::size_t shone = 0;  ///< spots with the first light: many more than modules found say that it went wrong
    };
    std::optional<Scan> scan{};
};

/// What devices reported. It grows, and nothing in it is ever changed by a decision, but for a view that is scanned
/// anew: the older scan of it stays with the step that took its place.
struct Measured {
    Skin skin;  ///< without the operator's word on links
    std::vector<GravityReading> gravity;
    std::vector<ScannedView> views;
    UnknownKeys unknown{};  ///< of the recording that was read, see Recording
    std::map<std::string, UnknownKeys> unknownOfTypes{};
};

/// A link whichever end it is seen from.
struct LinkKey {
    ModuleId a;
    int a_port = 0;
    ModuleId b;
    int b_port = 0;

    /// a is the smaller end.
    [[nodiscard]] static LinkKey of(const Link& link);
    friend auto operator<=>(const LinkKey&, const LinkKey&) = default;  // NOLINT(modernize-use-nullptr)
};

/// A module in a view.
struct DetectionKey {
    std::string view;
    ModuleId module;
    friend auto operator<=>(const DetectionKey&, const DetectionKey&) = default;  // NOLINT(modernize-use-nullptr)
};

/// All that the operator decided: one value. What a step changes of it is a DecisionChange.
struct Decisions {
    std::map<LinkKey, LinkKind> links;
    std::set<int> droppedPoses;
    std::set<std::string> droppedViews;
    std::map<DetectionKey, Decision> detections;
    std::optional<CameraModel> camera;
    CameraOrigin cameraOrigin{};  ///< of `camera`

    [[nodiscard]] bool operator==(const Decisions& other) const;
};

/// Both none, or equal to the last digit.
[[nodiscard]] bool sameCamera(const std::optional<CameraModel>& a, const std::optional<CameraModel>& b);

/// What a calibration is computed from: the measured minus what was dropped or rejected. Needs Decisions::camera where
/// there are views; without one they are left out.
[[nodiscard]] Measurements measurementsOf(const Measured& measured, const Decisions& decisions);

/// The same as a file. Dropped poses and views are not in it; rejected detections are, with the decision.
[[nodiscard]] Recording recordingOf(const Measured& measured, const Decisions& decisions);

/// A recording taken apart again. Views with pictures are not decoded yet.
struct OpenedRecording {
    Measured measured;
    Decisions decisions;
};
[[nodiscard]] OpenedRecording openedFrom(const Recording& recording);

/// The skin as it is now, where it is the one that was measured before: the same modules; or some that are known by
/// their unique ids, while others do not answer today or have been added. Modules that do not answer stay in it, with
/// their links. Nothing where it is another skin.
[[nodiscard]] std::optional<Skin> sameSkin(const Skin& before, const Skin& now);

/// Numbers of the poses that count, rising.
[[nodiscard]] std::vector<int> posesOf(const Measured& measured, const Decisions& decisions);

}  // namespace skincal
