#include "core/camera/webcam_source.h"

#include <QCamera>
#include <QCameraDevice>
#include <QMediaCaptureSession>
#include <QVideoSink>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace skincal {
namespace {

std::chrono::microseconds periodOf(const FrameFormat& format) {
    return std::chrono::microseconds(format.framesPerSecond > 0 ? std::llround(1e6 / format.framesPerSecond) : 0);
}

/// Luma without conversion first, pictures that have to be decoded last.
int effortOf(QVideoFrameFormat::PixelFormat format) {
    using Format = QVideoFrameFormat::PixelFormat;
    switch (format) {
        case Format::Format_Jpeg:
            return 2;
        case Format::Format_Invalid:
            return 3;
        case Format::Format_Y8:
        case Format::Format_YUV420P:
        case Format::Format_YUV422P:
        case Format::Format_NV12:
        case Format::Format_NV21:
        case Format::Format_YV12:
        case Format::Format_YUYV:
        case Format::Format_UYVY:
            return 0;
        default:
            return 1;
    }
}

QCameraFormat formatOf(const QCameraDevice& device, const FrameFormat& wanted) {
    QCameraFormat best;
    double bestCost = 1e9;
    for (const QCameraFormat& format : device.videoFormats()) {
        if (format.resolution() != QSize(wanted.width, wanted.height))
            continue;
        const double cost = 100 * std::abs(static_cast<double>(format.maxFrameRate()) - wanted.framesPerSecond) +
                            effortOf(format.pixelFormat());
        if (cost < bestCost) {
            bestCost = cost;
            best = format;
        }
    }
    return best;
}

}  // namespace

struct WebcamSource::Pipeline {
    // The session is gone before what it refers to.
    QCamera camera;
    QVideoSink sink;
    QMediaCaptureSession session;

    Pipeline(const QCameraDevice& device, const QCameraFormat& format) : camera(device) {
        // The sink first: with Qt 6.4 a sink that comes after the camera may wait for ever to begin (in one of four
        // runs), and nobody says so.
        session.setVideoSink(&sink);
        if (!format.isNull())
            camera.setCameraFormat(format);
        session.setCamera(&camera);
    }
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;
    ~Pipeline() {
        camera.stop();
        session.setCamera(nullptr);
        session.setVideoSink(nullptr);
    }
};

WebcamSource::WebcamSource(std::shared_ptr<CameraList> list, ListedCamera camera, WebcamOptions options,
                           QObject* parent)
    : VideoSource(parent),
      list_(std::move(list)),
      camera_(std::move(camera)),
      options_(options),
      format_(usualFormat(camera_.formats)) {
    settle_.setSingleShot(true);
    connect(&settle_, &QTimer::timeout, this, &WebcamSource::lock);
    connect(list_.get(), &CameraList::changed, this, &WebcamSource::listChanged);
}

WebcamSource::~WebcamSource() {
    stop();
}

QString WebcamSource::name() const {
    return QString::fromStdString(camera_.description);
}

void WebcamSource::setFormat(const FrameFormat& format) {
    if (std::find(camera_.formats.begin(), camera_.formats.end(), format) == camera_.formats.end())
        throw std::logic_error("WebcamSource: not one of its formats");
    if (format == format_)
        return;
    format_ = format;
    if (!isRunning())
        return;
    stop();
    start();
}

void WebcamSource::start() {
    if (isRunning())
        return;
    isGone_ = false;
    list_->refresh();
    const ListedCamera* found = findAgain(list_->cameras(), camera_);
    const QCameraDevice device = found != nullptr ? CameraList::deviceOf(*found) : QCameraDevice();
    if (device.isNull()) {
        isGone_ = true;
        fail({CameraTrouble::NotPluggedIn, name()});
        return;
    }
    camera_ = *found;
    if (std::find(camera_.formats.begin(), camera_.formats.end(), format_) == camera_.formats.end())
        format_ = usualFormat(camera_.formats);
    pipeline_ = std::make_unique<Pipeline>(device, formatOf(device, format_));
    // Queued: it may come while the camera is still being started.
    connect(
        &pipeline_->camera, &QCamera::errorOccurred, this,
        [this](QCamera::Error error, const QString& text) {
            if (error == QCamera::NoError || !isRunning())
                return;
            CameraFailure failure{CameraTrouble::CannotOpen, QString::fromStdString(camera_.node), text};
            fail(std::move(failure));
        },
        Qt::QueuedConnection);
    constexpr int kWarmUp = 6;  // a fifth of a second, when webcams are dark or too bright anyway
    RunOptions run{options_.watchdog, periodOf(format_), periodOf(format_), kWarmUp};
    run.watchdog.width = format_.width;
    run.watchdog.height = format_.height;
    // A frame's time lies a period before it came, and slow cameras need more patience.
    run.watchdog.nextPicture = std::max(run.watchdog.nextPicture, 4 * run.period);
    begin(pipeline_->sink, run);
    pipeline_->camera.start();
}

void WebcamSource::close() {
    settle_.stop();
    unlock();
    pipeline_.reset();
}

void WebcamSource::accepted(const CameraFrame&) {
    if (isLocked_ || settle_.isActive())
        return;
    if (values_.empty())
        settle_.start(options_.settle);
    else
        lock();
}

CameraFailure WebcamSource::explained(CameraTrouble trouble) {
    list_->refresh();
    CameraFailure failure{trouble, QString::fromStdString(camera_.node)};
    if (findAgain(list_->cameras(), camera_) == nullptr) {
        isGone_ = true;
        failure.trouble = CameraTrouble::Unplugged;
    } else if (!camera_.node.empty()) {
        failure.trouble = diagnose(list_->system(), camera_.node).value_or(trouble);
    }
    return failure;
}

void WebcamSource::listChanged() {
    const ListedCamera* found = findAgain(list_->cameras(), camera_);
    if (isRunning() && (found == nullptr || found->id != camera_.id)) {
        // With another id it was out and in again: this run's pictures end all the same.
        isGone_ = true;
        fail({CameraTrouble::Unplugged, name()});
    }
    if (!isRunning() && isGone_ && found != nullptr) {
        isGone_ = false;
        // After failed(), where that is on its way.
        QMetaObject::invokeMethod(this, &FrameSource::returned, Qt::QueuedConnection);
    }
}

void WebcamSource::lock() {
    if (!isRunning() || isLocked_)
        return;
    isLocked_ = true;
    auto node = camera_.node.empty() ? tl::unexpected(0) : list_->system().open(camera_.node);
    if (node) {
        node_ = std::move(*node);
        lockByNode();
    } else {
        lockByQt();
    }
    emit abilitiesChanged();
}

void WebcamSource::lockByNode() {
    lock_ = lockControls(*node_, values_);
    values_.clear();
    for (const ControlState& state : lock_.states) {
        if (state.value)
            values_.emplace_back(state.control, *state.value);
    }
    if (lock_.states.front().outcome == ControlState::Outcome::Locked) {
        exposureRange_ = skincal::exposureRange(*node_);
        exposure_ = skincal::exposure(*node_);
    }
}

void WebcamSource::lockByQt() {
    using Outcome = ControlState::Outcome;
    QCamera& camera = pipeline_->camera;
    lock_ = {};
    for (const CameraControl control : kCameraControls)
        lock_.states.push_back({control, Outcome::NoAccess, {}});
    const auto outcomeOf = [](bool isManual) { return isManual ? Outcome::Locked : Outcome::Automatic; };
    if (camera.isExposureModeSupported(QCamera::ExposureManual)) {
        camera.setExposureMode(QCamera::ExposureManual);
        lock_.states[0].outcome = outcomeOf(camera.exposureMode() == QCamera::ExposureManual);
    }
    if (camera.isFocusModeSupported(QCamera::FocusModeManual)) {
        camera.setFocusMode(QCamera::FocusModeManual);
        lock_.states[2].outcome = outcomeOf(camera.focusMode() == QCamera::FocusModeManual);
    }
    if (camera.isWhiteBalanceModeSupported(QCamera::WhiteBalanceManual)) {
        camera.setWhiteBalanceMode(QCamera::WhiteBalanceManual);
        lock_.states[3].outcome = outcomeOf(camera.whiteBalanceMode() == QCamera::WhiteBalanceManual);
    }
}

void WebcamSource::unlock() {
    if (!std::exchange(isLocked_, false))
        return;
    if (node_) {
        // Unplugged, it can't be helped: it forgets everything anyway.
        static_cast<void>(restoreControls(*node_, lock_));
        node_.reset();
    } else if (pipeline_) {
        QCamera& camera = pipeline_->camera;
        if (camera.exposureMode() == QCamera::ExposureManual)
            camera.setExposureMode(QCamera::ExposureAuto);
        if (camera.focusMode() == QCamera::FocusModeManual)
            camera.setFocusMode(QCamera::FocusModeAuto);
        if (camera.whiteBalanceMode() == QCamera::WhiteBalanceManual)
            camera.setWhiteBalanceMode(QCamera::WhiteBalanceAuto);
    }
    lock_ = {};
    exposureRange_.reset();
    exposure_.reset();
}

std::vector<ControlState> WebcamSource::controls() const {
    return lock_.states;
}

void WebcamSource::setExposure(double seconds) {
    if (std::isnan(seconds))
        throw std::logic_error("WebcamSource: exposure is not a number");
    if (!node_ || !exposureRange_ || !skincal::setExposure(*node_, seconds))
        return;
    exposure_ = skincal::exposure(*node_);
    // Kept for the next start.
    for (auto& [control, value] : values_) {
        if (control == CameraControl::Exposure)
            value = static_cast<std::int32_t>(std::lround(exposure_.value_or(seconds) * 1e4));
    }
}

}  // namespace skincal
