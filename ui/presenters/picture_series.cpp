#include "ui/presenters/picture_series.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/vision/light_change.h"
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
    pictures_.assign(lit_.size(), {});
    frames_.assign(lit_.size(), {});
    began_ = now();
    paused_.reset();
    told_ = 0;
    before_ = unpaced_ = 0;
    if (workbench_.skin() != nullptr)
        workbench_.skin()->prepare(lit_);
    handle(scan_run::Start{lit_.size(), toggles(), workbench_.cameraLag()});
}

void PictureSeries::extend(const LitSets& more) {
    if (state_.phase != ScanRun::Phase::Decoding)
        return;
    const std::size_t look = frames_.back().look + 1;
    lit_.insert(lit_.end(), more.begin(), more.end());
    pictures_.resize(lit_.size());
    frames_.resize(lit_.size(), {{}, {}, {}, look});
    if (workbench_.skin() != nullptr)
        workbench_.skin()->prepare(more);
    // Time and share are of this look alone, and decoding is no picture's.
    began_ = now();
    before_ = unpaced_ = state_.taken();
    handle(scan_run::Extend{more.size()});
}

scan_run::Toggles PictureSeries::toggles() const {
    constexpr std::size_t kWorthIt = 8;
    const auto isSmaller = [](const auto& a, const auto& b) { return a.size() < b.size(); };
    const FrameSource* camera = workbench_.camera();
    const SkinDevice* skin = workbench_.skin();
    if (camera == nullptr || skin == nullptr || lit_.size() < kWorthIt || !lit_[0].empty() ||
        lit_[1].size() < std::max_element(lit_.begin(), lit_.end(), isSmaller)->size())
        return scan_run::Toggles::None;
    // A time that means another to the camera is none.
    constexpr std::chrono::milliseconds kSame{2};
    const auto skinsTime = skin->now();
    const bool isOneClock = skinsTime && std::chrono::abs(*skinsTime - camera->now()) < kSame;
    return isOneClock ? scan_run::Toggles::GivenTime : scan_run::Toggles::AtOnce;
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
    const std::size_t frames = state_.frames - before_;
    const std::size_t taken = std::max(state_.taken(), before_) - before_;
    return frames == 0 ? 0 : static_cast<double>(taken) / static_cast<double>(frames);
}

std::optional<std::chrono::milliseconds> PictureSeries::timeLeft() const {
    // Timing light is slow, and over soon.
    if (!state_.isRunning() || state_.phase == ScanRun::Phase::Timing || state_.taken() <= unpaced_)
        return std::nullopt;
    const auto soFar = std::chrono::duration_cast<std::chrono::milliseconds>(now() - began_);
    return soFar * static_cast<int>(state_.left.size()) / static_cast<int>(state_.taken() - unpaced_);
}

ScanRun::Time PictureSeries::now() const {
    return workbench_.camera() != nullptr ? workbench_.camera()->now() : ScanRun::Time{0};
}

void PictureSeries::attachCamera() {
    newest_ = {};
    fail(ScanRun::Fault::OtherCamera);
    connect(workbench_.camera(), &FrameSource::frameArrived, this, &PictureSeries::take);
    connect(workbench_.camera(), &FrameSource::failed, this, [this](const QString& why) {
        newest_ = {};
        fail(ScanRun::Fault::CameraFailed, failureWords(*workbench_.camera(), why));
    });
}

void PictureSeries::take(const CameraFrame& frame) {
    // One that comes twice shows what was lit before, whatever its time says.
    const bool isAgain = !workbench_.camera()->mayStandStill() && isSamePicture(frame.image, newest_.image) &&
                         !isOfOneLevel(frame.image);
    newest_ = frame;
    if (!state_.isRunning() || isAgain)
        return;
    const bool isCompared = state_.phase == ScanRun::Phase::Timing && !state_.toggles.empty();
    const double change = isCompared ? lightChange(frame.image, reference_) : 0;
    handle(scan_run::PictureTaken{frame.time, workbench_.camera()->now(), change});
}

void PictureSeries::keep(std::size_t frame) {
    pictures_[frame] = newest_.image;
    frames_[frame].lit = lit_[frame];
    frames_[frame].time_s = std::chrono::duration<double>(newest_.time).count();
    while (told_ < pictures_.size() && !pictures_[told_].empty())
        emit kept(told_++);
}

PictureSeries::Taken PictureSeries::taken() const {
    std::vector<std::size_t> order(frames_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(frames_[a].look, *frames_[a].time_s) < std::pair(frames_[b].look, *frames_[b].time_s);
    });
    Taken taken;
    auto pictures = std::make_shared<Pictures>();
    for (const std::size_t k : order) {
        pictures->push_back(pictures_[k]);
        taken.frames.push_back(frames_[k]);
    }
    taken.pictures = std::move(pictures);
    return taken;
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
    // News alone: what is left of a scan says nothing of a camera that was chosen since.
    if (state_.slowest > before.slowest)
        workbench_.noteCameraLag(state_.slowest);
    if (state_.phase == ScanRun::Phase::Paused && !paused_)
        paused_ = now();
    else if (state_.isRunning() && paused_)
        began_ += now() - *std::exchange(paused_, std::nullopt);
    if (before.phase == ScanRun::Phase::Timing && state_.phase > ScanRun::Phase::Timing) {
        began_ = now();
        unpaced_ = state_.taken();
    }
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
                       const auto& lit = lit_[light.frame];
                       const ScanRun::Time commanded = now();
                       const std::uint64_t token = light.at ? skin->lightAt(lit, *light.at) : skin->light(lit);
                       handle(scan_run::LightCommanded{token, commanded});
                   },
                   [&](scan_run::TakeReference) { reference_ = newest_.image; },
                   [&](const scan_run::KeepPicture& picture) { keep(picture.frame); },
                   [&](scan_run::LightsOff) {
                       if (skin != nullptr)
                           skin->light({});
                   },
                   [&](scan_run::Decode) { emit complete(); },
                   [&](scan_run::Discard) {
                       pictures_.clear();
                       emit discarded();
                   },
                   [&](const StartTimer& timer) { timer_.start(timer.after); }, [&](StopTimer) { timer_.stop(); }},
        effect);
}

}  // namespace skincal
