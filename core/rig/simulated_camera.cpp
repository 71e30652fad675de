#include "core/rig/simulated_camera.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/rig/board_painter.h"
#include "core/rig/render_worker.h"

namespace skincal {
namespace {

constexpr std::uint64_t kFramesPerSecond = 30;
constexpr double kShortest = 1.0 / 2000;
constexpr double kLongest = 1.0 / 30;

// Disturbances run their course and begin again: who walks by comes back. A multiple of the lamp's beat.
constexpr std::uint64_t kCourse = 510;

RigClock::Time timeOf(std::uint64_t frame) {
    return RigClock::Time(static_cast<RigClock::Time::rep>(frame * 1'000'000 / kFramesPerSecond));
}

}  // namespace

SimulatedCamera::SimulatedCamera(SimulatedRig& rig, QObject* parent)
    : FrameSource(parent), rig_(&rig), world_(rig.sharedWorld()), chance_(world_->seed, "lost pictures") {
    worker_ = std::make_unique<RenderWorker>(
        world_, [this] { QMetaObject::invokeMethod(this, &SimulatedCamera::deliver, Qt::QueuedConnection); });
    connect(&rig, &SimulatedRig::cameraPulled, this, &SimulatedCamera::unplugged);
    connect(&rig, &QObject::destroyed, this, &SimulatedCamera::shut);
}

SimulatedCamera::~SimulatedCamera() {
    shut();
    // While this is still one: the worker calls it.
    worker_.reset();
}

QString SimulatedCamera::name() const {
    return QStringLiteral("Simulated webcam");
}

std::vector<FrameFormat> SimulatedCamera::formats() const {
    return {format()};
}

FrameFormat SimulatedCamera::format() const {
    const CameraModel& camera = world_->scenario.camera;
    return {camera.width, camera.height, static_cast<double>(kFramesPerSecond)};
}

void SimulatedCamera::setFormat(const FrameFormat& wanted) {
    if (wanted != format())
        throw std::logic_error("SimulatedCamera: not one of its formats");
}

std::optional<std::pair<double, double>> SimulatedCamera::exposureRange() const {
    return std::pair(kShortest, kLongest);
}

std::optional<double> SimulatedCamera::exposure() const {
    return exposure_;
}

void SimulatedCamera::setExposure(double seconds) {
    if (std::isnan(seconds))
        throw std::logic_error("SimulatedCamera: exposure is not a number");
    exposure_ = std::clamp(seconds, kShortest, kLongest);
}

std::chrono::microseconds SimulatedCamera::now() const {
    return rig_ ? rig_->now() : FrameSource::now();
}

void SimulatedCamera::soon(std::function<void()> what) {
    if (rig_)
        rig_->clock().at(rig_->now(), this, std::move(what));
    else
        QMetaObject::invokeMethod(this, std::move(what), Qt::QueuedConnection);
}

void SimulatedCamera::start() {
    if (running_)
        return;
    if (!rig_ || !rig_->isCameraPlugged()) {
        soon([this] { emit failed(tr("no camera is plugged in")); });
        return;
    }
    running_ = true;
    ++run_;
    startedAt_ = rig_->now();
    firstSequence_ = sequence_;
    rig_->clock().at(startedAt_, this, [this, run = run_] { expose(run, 0); });
}

void SimulatedCamera::stop() {
    if (!running_)
        return;
    shut();
    soon([this] { emit stopped(); });
}

void SimulatedCamera::shut() {
    running_ = false;
    ++run_;
    letTimeGoOn();
}

void SimulatedCamera::unplugged() {
    if (!running_)
        return;
    shut();
    soon([this] {
        // The first may destroy this.
        const QPointer<SimulatedCamera> self(this);
        emit failed(tr("the camera was unplugged"));
        if (self)
            emit stopped();
    });
}

/// @param frame  since the camera was started
void SimulatedCamera::expose(std::uint64_t run, std::uint64_t frame) {
    if (run != run_)
        return;
    const Time time = startedAt_ + timeOf(frame);
    sequence_ = firstSequence_ + frame;
    RenderRequest request;
    request.T_r_v = rig_->cameraPose(time);
    request.lit = rig_->litDuring(time);
    request.shutter = rig_->shutter();
    request.frame = sequence_ % kCourse;
    request.colour = world_->scenario.views.scan == ScanKind::Coloured;
    request.exposure = exposure_ / kUsualExposure;
    if (const auto& board = rig_->heldBoard()) {
        request.board = board->plan();
        const auto shutter = std::chrono::duration<double>(exposure_);
        const auto end = time + std::chrono::duration_cast<Time>(shutter);
        const int moments = board->isStill(time) && board->isStill(end) ? 1 : BoardPainter::kSamples;
        for (int k = 0; k < moments; ++k)
            request.T_v_b.push_back(board->pose(time + k * std::chrono::duration_cast<Time>(shutter) / moments));
    }
    request.run = run;
    request.caption.time = time;
    request.caption.sequence = sequence_++;
    if (rig_->clock().speed() == 0 && !holdsClock_) {
        rig_->clock().hold();
        holdsClock_ = true;
    }
    worker_->draw(std::move(request));
    // What nobody had time for was exposed all the same: it counts, but is not drawn.
    std::uint64_t next = frame + 1;
    const Time now = rig_->now();
    while (startedAt_ + timeOf(next + 1) <= now)
        ++next;
    rig_->clock().at(startedAt_ + timeOf(next), this, [this, run, next] { expose(run, next); });
}

void SimulatedCamera::deliver() {
    auto picture = worker_->take();
    if (!picture || picture->run != run_)
        return;
    letTimeGoOn();
    const double chance = chance_.uniform();
    if (chance < dropped_)
        return;
    if (chance < dropped_ + repeated_ && !last_.empty())
        picture->frame.image = last_;
    last_ = picture->frame.image;
    emit frameArrived(picture->frame);
}

void SimulatedCamera::setLosses(double dropped, double repeated) {
    if (!(dropped >= 0) || !(repeated >= 0) || !(dropped + repeated <= 1))
        throw std::logic_error("SimulatedCamera: no shares");
    dropped_ = dropped;
    repeated_ = repeated;
}

void SimulatedCamera::letTimeGoOn() {
    if (holdsClock_ && rig_)
        rig_->clock().release();
    holdsClock_ = false;
}

}  // namespace skincal
