#pragma once

#include <QUrl>
#include <memory>

#include "core/camera/video_source.h"

namespace skincal {

/// What an operator typed: a path, or the address of a stream (rtsp, http and what else GStreamer plays; udp:// and
/// gst-pipeline: are not played by Qt 6.4). Nothing where it is neither.
[[nodiscard]] std::optional<QUrl> videoUrl(const QString& typed);

/// A video file or a stream through Qt Multimedia, at its own pace, from the beginning at every start. It fails where
/// it can't be played and where it is over. Streams may pause for five seconds.
class MediaSource : public VideoSource {
    Q_OBJECT
  public:
    explicit MediaSource(QUrl url, FrameWatchdogOptions options = {}, QObject* parent = nullptr);
    ~MediaSource() override;

    /// The file's name, or the address without user and password.
    [[nodiscard]] QString name() const override;
    [[nodiscard]] std::vector<FrameFormat> formats() const override;
    /// That of the first picture; all zero before.
    [[nodiscard]] FrameFormat format() const override { return format_; }
    /// Throws std::logic_error where it is none of formats().
    void setFormat(const FrameFormat& format) override;
    [[nodiscard]] std::optional<std::pair<double, double>> exposureRange() const override { return std::nullopt; }
    [[nodiscard]] std::optional<double> exposure() const override { return std::nullopt; }
    void setExposure(double) override {}
    [[nodiscard]] bool mayStandStill() const override { return true; }
    void start() override;

  protected:
    void close() override;
    void accepted(const CameraFrame& frame) override;
    [[nodiscard]] CameraFailure explained(CameraTrouble trouble) override;

  private:
    struct Player;

    [[nodiscard]] bool isOver() const;

    QUrl url_;
    FrameWatchdogOptions options_;
    FrameFormat format_;
    std::unique_ptr<Player> player_;
    bool wasOver_ = false;  ///< when it was closed
};

}  // namespace skincal
