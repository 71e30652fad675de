#pragma once

#include <QTimer>
#include <memory>

#include "core/camera/camera_clock.h"
#include "core/camera/frame_source.h"
#include "core/camera/frame_watchdog.h"

class QVideoFrame;
class QVideoSink;

namespace skincal {

/// What webcams and videos have in common: frames come from a QVideoSink, get a time and a number, and only good ones
/// go on; where none come any more, it fails, for Qt Multimedia 6.4 says nothing about most of what can happen.
class VideoSource : public FrameSource {
    Q_OBJECT
  public:
    explicit VideoSource(QObject* parent = nullptr);
    ~VideoSource() override;

    [[nodiscard]] bool isRunning() const { return run_ != nullptr; }
    [[nodiscard]] std::array<std::uint64_t, kFrameFaults> refused() const override { return refused_; }
    [[nodiscard]] std::optional<CameraFailure> failure() const override { return failure_; }
    void stop() override;

  protected:
    struct RunOptions {
        FrameWatchdogOptions watchdog;
        std::chrono::microseconds period{};  ///< between two frames; 0 where it is not known
        std::chrono::microseconds lead{};    ///< of the exposure, see CameraClock
        /// Frames that are dated and not passed on: until the shortest delay is known, dates are late.
        int warmUp = 0;
    };

    /// From now on frames of the sink are passed on, those of an earlier run no more.
    void begin(QVideoSink& sink, const RunOptions& options);
    /// Ends the run, closes the device and says why; where it did not run, says it all the same. From the event loop.
    void fail(CameraFailure failure);

    /// Closes what gives the frames; the run is over. Called once for each begin(), by stop() and fail(): those who
    /// derive from this call stop() in their destructor.
    virtual void close() = 0;
    /// After each good frame; it may end the run.
    virtual void accepted(const CameraFrame& frame) = 0;
    /// What is behind a trouble that the watchdog noticed; the device is closed.
    [[nodiscard]] virtual CameraFailure explained(CameraTrouble trouble) = 0;

  private:
    struct Run;

    void deliver();
    void watch();
    void end();

    std::unique_ptr<Run> run_;  ///< null while it does not run
    QTimer watch_;
    std::uint64_t sequence_ = 0;
    std::array<std::uint64_t, kFrameFaults> refused_{};
    std::optional<CameraFailure> failure_;
};

/// A short sentence for a trouble, in the language of the program.
[[nodiscard]] QString shortReason(const CameraFailure& failure);

}  // namespace skincal
