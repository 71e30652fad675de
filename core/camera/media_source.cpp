#include "core/camera/media_source.h"

#include <QFileInfo>
#include <QMediaPlayer>
#include <QVideoFrame>
#include <QVideoSink>
#include <algorithm>
#include <stdexcept>

#include "core/camera/camera_list.h"

namespace skincal {

std::optional<QUrl> videoUrl(const QString& typed) {
    const QString text = typed.trimmed();
    if (text.isEmpty())
        return std::nullopt;
    // Addresses have two slashes; "C:" and names with a colon are paths.
    const QUrl url = text.contains(QStringLiteral("://")) ? QUrl(text, QUrl::StrictMode)
                                                          : QUrl::fromLocalFile(QFileInfo(text).absoluteFilePath());
    const QString scheme = url.scheme();
    if (!url.isValid() || scheme == QStringLiteral("udp") || scheme == QStringLiteral("gst-pipeline"))
        return std::nullopt;
    return url;
}

struct MediaSource::Player {
    QVideoSink sink;
    QMediaPlayer player;

    Player() { player.setVideoSink(&sink); }
    Player(const Player&) = delete;
    Player& operator=(const Player&) = delete;
    ~Player() {
        player.stop();
        player.setVideoSink(nullptr);
    }
};

MediaSource::MediaSource(QUrl url, FrameWatchdogOptions options, QObject* parent)
    : VideoSource(parent), url_(std::move(url)), options_(options) {
    prepareMultimedia();
    // What was compressed may well repeat a picture to the last pixel.
    options_.mayStandStill = true;
    if (!url_.isLocalFile()) {
        // Networks pause.
        options_.firstPicture = std::max(options_.firstPicture, FrameWatchdogOptions::Time(std::chrono::seconds(15)));
        options_.nextPicture = std::max(options_.nextPicture, FrameWatchdogOptions::Time(std::chrono::seconds(5)));
    }
}

MediaSource::~MediaSource() {
    stop();
}

QString MediaSource::name() const {
    return url_.isLocalFile() ? url_.fileName() : url_.toDisplayString(QUrl::RemoveUserInfo);
}

std::vector<FrameFormat> MediaSource::formats() const {
    return format_.width > 0 ? std::vector{format_} : std::vector<FrameFormat>();
}

void MediaSource::setFormat(const FrameFormat& format) {
    if (format_.width == 0 || format != format_)
        throw std::logic_error("MediaSource: not one of its formats");
}

void MediaSource::start() {
    if (isRunning())
        return;
    if (url_.isLocalFile() && !QFileInfo(url_.toLocalFile()).isFile()) {
        fail({CameraTrouble::Missing, url_.toLocalFile()});
        return;
    }
    if (url_.isLocalFile() && !QFileInfo(url_.toLocalFile()).isReadable()) {
        fail({CameraTrouble::Forbidden, url_.toLocalFile()});
        return;
    }
    wasOver_ = false;
    player_ = std::make_unique<Player>();
    QMediaPlayer& player = player_->player;
    // Queued: the player must not be destroyed within a signal of its own.
    connect(
        &player, &QMediaPlayer::errorOccurred, this,
        [this](QMediaPlayer::Error error, const QString& text) {
            if (isRunning() && error != QMediaPlayer::NoError)
                fail({CameraTrouble::CannotPlay, name(), text});
        },
        Qt::QueuedConnection);
    connect(
        &player, &QMediaPlayer::mediaStatusChanged, this,
        [this](QMediaPlayer::MediaStatus status) {
            if (!isRunning())
                return;
            if (status == QMediaPlayer::EndOfMedia)
                fail({CameraTrouble::Ended, name()});
            else if (status == QMediaPlayer::InvalidMedia)
                fail({CameraTrouble::CannotPlay, name(), player_->player.errorString()});
        },
        Qt::QueuedConnection);
    RunOptions run;
    run.watchdog = options_;
    begin(player_->sink, run);
    player.setSource(url_);
    player.play();
}

bool MediaSource::isOver() const {
    constexpr qint64 kNearEnd_ms = 500;
    const QMediaPlayer& player = player_->player;
    return player.duration() > 0 && player.position() >= player.duration() - kNearEnd_ms;
}

void MediaSource::close() {
    wasOver_ = isOver();
    player_.reset();
}

void MediaSource::accepted(const CameraFrame& frame) {
    if (format_.width == frame.image.cols && format_.height == frame.image.rows)
        return;
    // The player's metadata have no rate with Qt 6.4.
    const auto rate = static_cast<double>(player_->sink.videoFrame().surfaceFormat().frameRate());
    format_ = {frame.image.cols, frame.image.rows, rate};
    emit abilitiesChanged();
}

CameraFailure MediaSource::explained(CameraTrouble trouble) {
    if (trouble == CameraTrouble::Silent && wasOver_)
        trouble = CameraTrouble::Ended;
    if (trouble == CameraTrouble::NoFirstPicture)
        trouble = CameraTrouble::CannotPlay;
    return {trouble, name()};
}

}  // namespace skincal
