#pragma once

#include <QObject>
#include <QString>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera/camera_controls.h"
#include "core/camera/camera_frame.h"
#include "core/camera/camera_trouble.h"

namespace skincal {

/// Why a source ended, for whom it has to be said in words.
struct CameraFailure {
    CameraTrouble trouble{};
    QString where{};   ///< the device's node or the file, where it matters
    QString detail{};  ///< what the multimedia library said
};

/// Something that gives pictures: a webcam, a video file, a simulation. Asynchronous like SkinDevice; frames that
/// nobody has fetched are replaced by newer ones, never queued.
class FrameSource : public QObject {
    Q_OBJECT
  public:
    using QObject::QObject;

    [[nodiscard]] virtual QString name() const = 0;
    /// Empty while that is not known: of a video before its first picture.
    [[nodiscard]] virtual std::vector<FrameFormat> formats() const = 0;
    [[nodiscard]] virtual FrameFormat format() const = 0;
    /// One of formats(); takes effect at once where it runs.
    virtual void setFormat(const FrameFormat& format) = 0;
    /// Shortest and longest exposure in seconds; nothing where it can't be set.
    [[nodiscard]] virtual std::optional<std::pair<double, double>> exposureRange() const = 0;
    [[nodiscard]] virtual std::optional<double> exposure() const = 0;
    virtual void setExposure(double seconds) = 0;

    /// Now, on the clock of CameraFrame::time: a picture of a later time was exposed after this moment, however late it
    /// comes.
    [[nodiscard]] virtual std::chrono::microseconds now() const {
        return std::chrono::duration_cast<std::chrono::microseconds>(
            std::chrono::steady_clock::now().time_since_epoch());
    }

    /// Whether one picture may equal the one before it to the last pixel: what was compressed does where nothing moves.
    /// From a sensor it is the same picture come twice.
    [[nodiscard]] virtual bool mayStandStill() const { return false; }

    /// What became of the controls that should stand still while pictures are taken; empty where nothing is to be said
    /// of them: before they are locked, and of what is no camera.
    [[nodiscard]] virtual std::vector<ControlState> controls() const { return {}; }
    /// How many pictures of this run were not passed on, by FrameFault.
    [[nodiscard]] virtual std::array<std::uint64_t, kFrameFaults> refused() const { return {}; }
    /// Why failed() was said last; nothing where there is no more to say than its sentence.
    [[nodiscard]] virtual std::optional<CameraFailure> failure() const { return std::nullopt; }

    /// frameArrived() again and again, or failed().
    virtual void start() = 0;
    /// stopped() follows where it ran.
    virtual void stop() = 0;

  signals:
    void frameArrived(const skincal::CameraFrame& frame);
    void stopped();
    /// A short sentence in the language of the program; failure() has the code.
    void failed(const QString& why);
    /// Formats, exposure or controls are other than before.
    void abilitiesChanged();
    /// What failed since it was gone is there again: start() would do.
    void returned();
};

}  // namespace skincal
