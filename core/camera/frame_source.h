#pragma once

#include <QObject>
#include <QString>
#include <chrono>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace skincal {

/// A picture as the camera took it. The pixels are shared, never written to.
struct CameraFrame {
    cv::Mat image;                     ///< 8 bit, grey or BGR
    std::chrono::microseconds time{};  ///< of exposure, std::chrono::steady_clock since its epoch
    std::uint64_t sequence = 0;        ///< rises by one with every frame that the camera took, dropped ones included
};

struct FrameFormat {
    int width = 0;
    int height = 0;
    double framesPerSecond = 0;

    friend bool operator==(const FrameFormat&, const FrameFormat&) = default;
};

/// Something that gives pictures: a webcam, a video file, a simulation. Asynchronous like SkinDevice; frames that
/// nobody has fetched are replaced by newer ones, never queued.
class FrameSource : public QObject {
    Q_OBJECT
  public:
    using QObject::QObject;

    [[nodiscard]] virtual QString name() const = 0;
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

    /// frameArrived() again and again, or failed().
    virtual void start() = 0;
    /// stopped() follows where it ran.
    virtual void stop() = 0;

  signals:
    void frameArrived(const skincal::CameraFrame& frame);
    void stopped();
    void failed(const QString& why);
};

}  // namespace skincal
