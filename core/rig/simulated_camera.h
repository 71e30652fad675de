#pragma once

#include <QPointer>
#include <memory>

#include "core/camera/frame_source.h"
#include "core/geometry/random.h"
#include "core/rig/simulated_rig.h"

namespace skincal {

class RenderWorker;

/// The webcam of a rig: 30 pictures a second of its world, from where the camera is held, with the LEDs lit that the
/// skin was told to light (SimulatedRig::setCameraLatency). Pictures are drawn on a thread of its own.
///
/// A picture shows what there was at its time, which is the rig's. The first is exposed when the camera is started.
/// Where drawing takes longer than a thirtieth of a second (after the camera moved, as a rule), pictures are left out
/// and the sequence shows it; at clock speed 0 time waits for every picture, so that none is ever missing and it
/// arrives at its own time.
///
/// A board that is held before it (SimulatedRig::holdBoard) shows as its lens bends it, smeared while it moves.
///
/// Pictures are grey, of skins that are scanned in colours BGR, as with any picture that shows a coloured LED.
/// Unplugged, it fails and stops. It stops without a word where the rig is destroyed.
class SimulatedCamera : public FrameSource {
    Q_OBJECT
  public:
    /// Exposure at which the picture has the levels of RenderOptions, s.
    static constexpr double kUsualExposure = 1.0 / 60;

    explicit SimulatedCamera(SimulatedRig& rig, QObject* parent = nullptr);
    /// Waits until the picture that is being drawn is there, a tenth of a second at most as a rule.
    ~SimulatedCamera() override;

    [[nodiscard]] QString name() const override;
    /// The scenario's camera, 30 frames/s; nothing else.
    [[nodiscard]] std::vector<FrameFormat> formats() const override;
    [[nodiscard]] FrameFormat format() const override;
    /// Throws std::logic_error where it is none of formats().
    void setFormat(const FrameFormat& format) override;
    /// 1/2000 s to 1/30 s: light grows with it and clips at 255.
    [[nodiscard]] std::optional<std::pair<double, double>> exposureRange() const override;
    [[nodiscard]] std::optional<double> exposure() const override;
    /// The nearest within the range; std::logic_error where it is not a number. For pictures from now on.
    void setExposure(double seconds) override;
    [[nodiscard]] std::chrono::microseconds now() const override;
    void start() override;
    void stop() override;

    [[nodiscard]] bool isRunning() const { return running_; }
    /// Shares of pictures that never come, and that come with the pixels of the one before them: none at first. Throws
    /// std::logic_error where they are none.
    void setLosses(double dropped, double repeated);

  private:
    using Time = RigClock::Time;

    void soon(std::function<void()> what);
    void shut();
    void unplugged();
    void expose(std::uint64_t run, std::uint64_t frame);
    void deliver();
    void letTimeGoOn();

    QPointer<SimulatedRig> rig_;
    std::shared_ptr<const World> world_;
    double exposure_ = kUsualExposure;
    bool running_ = false;
    bool holdsClock_ = false;
    std::uint64_t run_ = 0;  ///< how often it was started or stopped
    Time startedAt_{};
    std::uint64_t firstSequence_ = 0;
    std::uint64_t sequence_ = 0;
    Random chance_;
    double dropped_ = 0;
    double repeated_ = 0;
    cv::Mat last_;
    std::unique_ptr<RenderWorker> worker_;
};

}  // namespace skincal
