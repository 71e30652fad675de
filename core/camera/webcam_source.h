#pragma once

#include <QTimer>
#include <memory>

#include "core/camera/camera_list.h"
#include "core/camera/control_lock.h"
#include "core/camera/video_source.h"

namespace skincal {

struct WebcamOptions {
    FrameWatchdogOptions watchdog;  ///< its size is the format's
    /// How long exposure and the like may find themselves before they are locked. From the second start on the values
    /// of the first are taken at once.
    std::chrono::milliseconds settle{1000};
};

/// A webcam through Qt Multimedia. It is looked up in the list before every start, for Qt shows a test picture in the
/// place of a camera that is gone. Unplugged, it fails and stops; plugged in again, returned() comes and start() works
/// as before, also where it has another id by then.
///
/// Exposure, gain, focus and white balance are locked through its Video4Linux node and restored when it stops, fails or
/// is destroyed: Qt 6.4 can't switch automatic exposure on again. Where the node isn't known, Qt's own controls are
/// used as far as they go. controls() says what came of it.
class WebcamSource : public VideoSource {
    Q_OBJECT
  public:
    WebcamSource(std::shared_ptr<CameraList> list, ListedCamera camera, WebcamOptions options = {},
                 QObject* parent = nullptr);
    ~WebcamSource() override;

    [[nodiscard]] QString name() const override;
    [[nodiscard]] std::vector<FrameFormat> formats() const override { return camera_.formats; }
    [[nodiscard]] FrameFormat format() const override { return format_; }
    /// Throws std::logic_error where it is none of formats().
    void setFormat(const FrameFormat& format) override;
    /// Known while it runs and its controls are locked.
    [[nodiscard]] std::optional<std::pair<double, double>> exposureRange() const override { return exposureRange_; }
    [[nodiscard]] std::optional<double> exposure() const override { return exposure_; }
    void setExposure(double seconds) override;
    [[nodiscard]] std::vector<ControlState> controls() const override;
    void start() override;

    /// As it was found last.
    [[nodiscard]] const ListedCamera& camera() const { return camera_; }

  protected:
    void close() override;
    void accepted(const CameraFrame& frame) override;
    [[nodiscard]] CameraFailure explained(CameraTrouble trouble) override;

  private:
    struct Pipeline;

    void listChanged();
    void lock();
    void lockByQt();
    void lockByNode();
    void unlock();

    std::shared_ptr<CameraList> list_;
    ListedCamera camera_;
    WebcamOptions options_;
    FrameFormat format_;
    std::unique_ptr<Pipeline> pipeline_;
    std::unique_ptr<V4l2Device> node_;  ///< while controls are locked
    ControlLock lock_;
    ControlValues values_;  ///< that were locked before
    QTimer settle_;
    bool isLocked_ = false;
    bool isGone_ = false;  ///< failed since it is not in the list
    std::optional<std::pair<double, double>> exposureRange_;
    std::optional<double> exposure_;
};

}  // namespace skincal
