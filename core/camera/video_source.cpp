#include "core/camera/video_source.h"

#include <QPointer>
#include <QVideoFrame>
#include <QVideoSink>

#include "core/camera/mailbox.h"
#include "core/camera/video_frame_picture.h"

namespace skincal {
namespace {

using Time = std::chrono::microseconds;

constexpr std::chrono::milliseconds kWatch{100};

struct Letter {
    QVideoFrame frame;
    Time arrival{};
};

QString wordsOf(CameraTrouble trouble) {
    switch (trouble) {
        case CameraTrouble::NotPluggedIn:
            return VideoSource::tr("the camera is not plugged in");
        case CameraTrouble::Unplugged:
            return VideoSource::tr("the camera was unplugged");
        case CameraTrouble::NoFirstPicture:
            return VideoSource::tr("the camera gives no pictures");
        case CameraTrouble::Silent:
            return VideoSource::tr("no pictures come any more");
        case CameraTrouble::Frozen:
            return VideoSource::tr("the camera gives the same picture again and again");
        case CameraTrouble::TestPicture:
            return VideoSource::tr("a test picture comes in the place of the camera's");
        case CameraTrouble::WrongSize:
            return VideoSource::tr("the pictures are not of the size that was asked for");
        case CameraTrouble::Late:
            return VideoSource::tr("the pictures come too late");
        case CameraTrouble::Unsteady:
            return VideoSource::tr("the times of the pictures do not rise");
        case CameraTrouble::Unreadable:
            return VideoSource::tr("the pictures cannot be read");
        case CameraTrouble::Forbidden:
            return VideoSource::tr("the camera may not be opened");
        case CameraTrouble::Busy:
            return VideoSource::tr("another program uses the camera");
        case CameraTrouble::CannotOpen:
            return VideoSource::tr("the camera cannot be opened");
        case CameraTrouble::Missing:
            return VideoSource::tr("there is no such file");
        case CameraTrouble::CannotPlay:
            return VideoSource::tr("the video cannot be played");
        default:
            return VideoSource::tr("the video is over");
    }
}

}  // namespace

QString shortReason(const CameraFailure& failure) {
    QString text = wordsOf(failure.trouble);
    for (const QString& more : {failure.where, failure.detail}) {
        if (!more.isEmpty())
            text += QStringLiteral(": ") + more;
    }
    return text;
}

/// Frames may come on a thread of the multimedia library's, and one may be on its way when a run ends: they hold the
/// mailbox, and nobody else looks into one of an earlier run.
struct VideoSource::Run {
    Run(const RunOptions& options, Time now, std::uint64_t first)
        : watchdog(options.watchdog, now), clock(options.period, options.lead, first), warmUp(options.warmUp) {}

    std::shared_ptr<Mailbox<Letter>> mailbox = std::make_shared<Mailbox<Letter>>();
    QMetaObject::Connection frames;
    FrameWatchdog watchdog;
    CameraClock clock;
    int warmUp;
};

VideoSource::VideoSource(QObject* parent) : FrameSource(parent) {
    watch_.setInterval(kWatch);
    watch_.setTimerType(Qt::PreciseTimer);
    connect(&watch_, &QTimer::timeout, this, &VideoSource::watch);
}

VideoSource::~VideoSource() = default;

void VideoSource::begin(QVideoSink& sink, const RunOptions& options) {
    failure_.reset();
    refused_ = {};
    run_ = std::make_unique<Run>(options, now(), sequence_ + 1);
    run_->frames = connect(
        &sink, &QVideoSink::videoFrameChanged, this,
        [this, mailbox = run_->mailbox](const QVideoFrame& frame) {
            // A frame without anything says that the pipeline was shut.
            if (frame.isValid() && mailbox->put({frame, VideoSource::now()}))
                QMetaObject::invokeMethod(this, &VideoSource::deliver, Qt::QueuedConnection);
        },
        Qt::DirectConnection);
    watch_.start();
}

void VideoSource::deliver() {
    if (!run_)
        return;
    const auto letter = run_->mailbox->take();
    if (!letter)
        return;
    const qint64 own = letter->frame.startTime();
    const auto stamp = run_->clock.stamp(own >= 0 ? std::optional(Time(own)) : std::nullopt, letter->arrival);
    if (run_->warmUp > 0) {
        --run_->warmUp;
        return;
    }
    const CameraFrame frame{pictureOf(letter->frame), stamp.time, stamp.sequence};
    if (run_->watchdog.judge(frame, now())) {
        refused_ = run_->watchdog.refused();
        return;
    }
    sequence_ = frame.sequence;
    const QPointer<VideoSource> self(this);
    emit frameArrived(frame);
    if (self && run_)
        accepted(frame);
}

void VideoSource::watch() {
    if (!run_)
        return;
    // What waits in the mailbox has come.
    deliver();
    if (!run_)
        return;
    if (const auto trouble = run_->watchdog.check(now())) {
        end();
        fail(explained(*trouble));
    }
}

void VideoSource::end() {
    watch_.stop();
    disconnect(run_->frames);
    run_.reset();
    close();
}

void VideoSource::stop() {
    if (!run_)
        return;
    end();
    QMetaObject::invokeMethod(this, &FrameSource::stopped, Qt::QueuedConnection);
}

void VideoSource::fail(CameraFailure failure) {
    const bool ran = run_ != nullptr;
    if (ran)
        end();
    failure_ = std::move(failure);
    QMetaObject::invokeMethod(
        this,
        [this, failure = *failure_] {
            // Started again meanwhile.
            if (run_)
                return;
            const QPointer<VideoSource> self(this);
            emit failed(shortReason(failure));
            if (self)
                emit stopped();
        },
        Qt::QueuedConnection);
}

}  // namespace skincal
