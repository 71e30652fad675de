#include "ui/presenters/picture_series.h"

#include "ui/presenters/camera_words.h"

namespace skincal {

QString sentenceOf(const ScanRun& run, const QString& words) {
    using Fault = ScanRun::Fault;
    switch (run.fault) {
        case Fault::None:
            return {};
        case Fault::SkinSilent:
            return PictureSeries::tr("the skin does not answer to light commands");
        case Fault::CameraSilent:
            return PictureSeries::tr("the camera gives no pictures");
        case Fault::SkinGone:
            return PictureSeries::tr("the skin was disconnected");
        case Fault::OtherSkin:
            return PictureSeries::tr("the skin is another one now");
        case Fault::OtherCamera:
            return PictureSeries::tr("another camera was chosen");
        case Fault::CameraFailed:
            return words.isEmpty() ? PictureSeries::tr("the camera failed") : words;
        default:
            return words.isEmpty() ? PictureSeries::tr("the pictures could not be decoded") : words;
    }
}

PictureSeries::PictureSeries(Workbench& workbench, QObject* parent) : QObject(parent), workbench_(workbench) {
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, [this] { handle(scan_run::TimedOut{}); });
    connect(&workbench, &Workbench::cameraChosen, this, &PictureSeries::attachCamera);
    connect(&workbench, &Workbench::skinChosen, this, &PictureSeries::attachSkin);
    connect(&workbench, &Workbench::skinReadyChanged, this, [this](bool ready) {
        if (!ready)
            fail(ScanRun::Fault::SkinGone);
    });
    connect(&workbench.session(), &Session::skinChanged, this, [this] { fail(ScanRun::Fault::OtherSkin); });
    if (workbench.camera() != nullptr)
        attachCamera();
    if (workbench.skin() != nullptr)
        attachSkin();
}

void PictureSeries::start(LitSets lit) {
    if (isBusy())
        return;
    lit_ = std::move(lit);
    pictures_ = std::make_shared<Pictures>(lit_.size());
    frames_.assign(lit_.size(), {});
    began_ = Clock::now();
    if (workbench_.skin() != nullptr)
        workbench_.skin()->prepare(lit_);
    handle(scan_run::Start{lit_.size()});
}

void PictureSeries::pause() {
    handle(scan_run::Pause{});
}

void PictureSeries::resume() {
    handle(scan_run::Resume{});
}

void PictureSeries::cancel() {
    handle(scan_run::Cancel{});
}

void PictureSeries::fail(ScanRun::Fault fault, const QString& words) {
    // What fails while nothing runs has not ended the last run.
    if (isBusy())
        words_ = words;
    handle(scan_run::Failed{fault});
}

void PictureSeries::finish() {
    handle(scan_run::Decoded{});
}

double PictureSeries::done() const {
    if (state_.phase == ScanRun::Phase::Decoding || state_.phase == ScanRun::Phase::Done)
        return 1;
    return state_.frames == 0 ? 0 : static_cast<double>(state_.next) / static_cast<double>(state_.frames);
}

std::optional<std::chrono::milliseconds> PictureSeries::timeLeft() const {
    if (!state_.isRunning() || state_.next == 0)
        return std::nullopt;
    const auto soFar = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - began_);
    return soFar * static_cast<int>(state_.frames - state_.next) / static_cast<int>(state_.next);
}

void PictureSeries::attachCamera() {
    newest_ = {};
    fail(ScanRun::Fault::OtherCamera);
    connect(workbench_.camera(), &FrameSource::frameArrived, this, [this](const CameraFrame& frame) {
        newest_ = frame;
        handle(scan_run::PictureTaken{frame.time});
    });
    connect(workbench_.camera(), &FrameSource::failed, this, [this](const QString& why) {
        newest_ = {};
        fail(ScanRun::Fault::CameraFailed, failureWords(*workbench_.camera(), why));
    });
}

void PictureSeries::attachSkin() {
    connect(workbench_.skin(), &SkinDevice::lightShown, this, [this](std::uint64_t token) {
        // By the camera's clock, not by the newest picture's time: pictures may be on their way for longer than light
        // takes to settle.
        if (const FrameSource* camera = workbench_.camera())
            handle(scan_run::LightShown{token, camera->now()});
    });
}

void PictureSeries::handle(const scan_run::Event& event) {
    const ScanRun before = state_;
    const auto [state, effects] = step(state_, event);
    state_ = state;
    if (before.isRunning() != state_.isRunning())
        emit runningChanged(state_.isRunning());
    for (const scan_run::Effect& effect : effects)
        act(effect);
    if (!(before == state_))
        emit stateChanged();
}

void PictureSeries::act(const scan_run::Effect& effect) {
    SkinDevice* skin = workbench_.skin();
    std::visit(
        Overloaded{[&](const scan_run::Light& light) {
                       const std::uint64_t token = skin->light(lit_[light.frame]);
                       handle(scan_run::LightCommanded{token});
                   },
                   [&](const scan_run::KeepPicture& keep) {
                       (*pictures_)[keep.frame] = newest_.image;
                       FrameInfo& frame = frames_[keep.frame];
                       frame.lit = lit_[keep.frame];
                       frame.time_s = std::chrono::duration<double>(newest_.time).count();
                       emit kept(keep.frame);
                   },
                   [&](scan_run::LightsOff) {
                       if (skin != nullptr)
                           skin->light({});
                   },
                   [&](scan_run::Decode) { emit complete(); },
                   [&](scan_run::Discard) {
                       pictures_.reset();
                       emit discarded();
                   },
                   [&](const StartTimer& timer) { timer_.start(timer.after); }, [&](StopTimer) { timer_.stop(); }},
        effect);
}

}  // namespace skincal
