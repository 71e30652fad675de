#include "ui/presenters/scan_presenter.h"

#include <QtConcurrent/QtConcurrentRun>

namespace skincal {
namespace {

bool needsCamera(const ScanRun& run) {
    return run.isRunning() || run.phase == ScanRun::Phase::Paused;
}

}  // namespace

ScanPresenter::ScanPresenter(Workbench& workbench, QObject* parent)
    : QObject(parent), workbench_(workbench), detections_(workbench) {
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, [this] { handle(scan_run::TimedOut{}); });
    connect(&workbench, &Workbench::cameraChosen, this, &ScanPresenter::attachCamera);
    connect(&workbench, &Workbench::skinChosen, this, &ScanPresenter::attachSkin);
    connect(&workbench, &Workbench::skinReadyChanged, this, [this](bool ready) {
        if (!ready)
            handle(scan_run::Failed{tr("the skin was disconnected").toStdString()});
        emit stateChanged();
    });
    connect(&workbench.session(), &Session::decisionsChanged, this, &ScanPresenter::stateChanged);
    const auto countPictures = [this] { picturesOfAScan_ = codedScan(modules(), 0).size(); };
    connect(&workbench.session(), &Session::skinChanged, this, [this, countPictures] {
        handle(scan_run::Failed{tr("the skin is another one now").toStdString()});
        countPictures();
    });
    countPictures();
    connect(&watcher_, &QFutureWatcherBase::finished, this, &ScanPresenter::decodingFinished);
    if (workbench.camera() != nullptr)
        attachCamera();
    if (workbench.skin() != nullptr)
        attachSkin();
}

ScanPresenter::~ScanPresenter() {
    if (cancelled_)
        *cancelled_ = true;
    watcher_.waitForFinished();
}

QString ScanPresenter::obstacle() const {
    if (!workbench_.isSkinReady())
        return tr("The skin is not connected.");
    if (workbench_.camera() == nullptr)
        return tr("No camera is chosen.");
    if (!workbench_.session().decisions().camera)
        return tr("The camera's intrinsics are not known.");
    if (newest_.image.empty() || !isPictureNew_)
        return tr("The camera gives no pictures yet.");
    const CameraModel& camera = *workbench_.session().decisions().camera;
    if (newest_.image.cols != camera.width || newest_.image.rows != camera.height)
        return tr("The intrinsics are for %1 × %2 pixels, the camera gives %3 × %4.")
            .arg(camera.width)
            .arg(camera.height)
            .arg(newest_.image.cols)
            .arg(newest_.image.rows);
    return {};
}

void ScanPresenter::start(const std::optional<std::string>& replaced) {
    if (!obstacle().isEmpty() || state_.isRunning())
        return;
    replaced_ = replaced;
    // Words change from scan to scan: what two modules that look alike confuse in one view they don't in the next.
    lit_ = codedScan(modules(), workbench_.session().measured().views.size());
    pictures_ = std::make_shared<Pictures>(lit_.size());
    frames_.assign(lit_.size(), {});
    began_ = Clock::now();
    handle(scan_run::Start{lit_.size()});
}

std::vector<ModuleId> ScanPresenter::modules() const {
    std::vector<ModuleId> modules;
    for (const SkinModule& module : workbench_.session().measured().skin.modules)
        modules.push_back(module.id);
    return modules;
}

void ScanPresenter::pause() {
    handle(scan_run::Pause{});
}

void ScanPresenter::resume() {
    handle(scan_run::Resume{});
}

void ScanPresenter::cancel() {
    handle(scan_run::Cancel{});
}

double ScanPresenter::done() const {
    if (state_.phase == ScanRun::Phase::Decoding || state_.phase == ScanRun::Phase::Done)
        return 1;
    return state_.frames == 0 ? 0 : static_cast<double>(state_.next) / static_cast<double>(state_.frames);
}

std::optional<std::chrono::milliseconds> ScanPresenter::timeLeft() const {
    if (!state_.isRunning() || state_.next == 0)
        return std::nullopt;
    const auto soFar = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - began_);
    return soFar * static_cast<int>(state_.frames - state_.next) / static_cast<int>(state_.next);
}

void ScanPresenter::showView(const std::string& view) {
    if (view == detections_.view())
        return;
    detections_.setView(view);
    emit shownViewChanged();
}

void ScanPresenter::setDropped(const std::string& view, bool dropped) {
    const QString text = dropped ? tr("Drop %1") : tr("Take %1 back");
    workbench_.session().decide(text.arg(view.c_str()), [&](Decisions& decisions) {
        if (dropped)
            decisions.droppedViews.insert(view);
        else
            decisions.droppedViews.erase(view);
    });
}

void ScanPresenter::setActive(bool active) {
    isActive_ = active;
    FrameSource* camera = workbench_.camera();
    const bool needed = active || needsCamera(state_);
    if (camera == nullptr || needed == isCameraRunning_)
        return;
    isCameraRunning_ = needed;
    // Its time would pass for the present.
    isPictureNew_ = false;
    needed ? camera->start() : camera->stop();
    emit stateChanged();
}

void ScanPresenter::attachCamera() {
    FrameSource* camera = workbench_.camera();
    isCameraRunning_ = false;
    isPictureNew_ = false;
    newest_ = {};
    handle(scan_run::Failed{tr("another camera was chosen").toStdString()});
    connect(camera, &FrameSource::frameArrived, this, [this](const CameraFrame& frame) {
        newest_ = frame;
        // What comes after the camera was stopped is late.
        const bool isFirst = isCameraRunning_ && !std::exchange(isPictureNew_, true);
        handle(scan_run::PictureTaken{frame.time});
        emit pictureChanged();
        if (isFirst)
            emit stateChanged();
    });
    connect(camera, &FrameSource::failed, this, [this](const QString& why) {
        newest_ = {};
        // While it counts as running, so that the end of the scan does not start it again.
        handle(scan_run::Failed{why.toStdString()});
        isCameraRunning_ = false;
        emit cameraFailed(why);
        emit pictureChanged();
    });
    setActive(isActive_);
}

void ScanPresenter::attachSkin() {
    connect(workbench_.skin(), &SkinDevice::lightShown, this, [this](std::uint64_t token) {
        // Only pictures tell their clock's time. The next one may have been exposed just before this moment.
        const FrameSource* camera = workbench_.camera();
        const double rate = camera != nullptr ? camera->format().framesPerSecond : 0;
        const std::chrono::duration<double> frame(rate > 0 ? 1 / rate : 0.1);
        handle(
            scan_run::LightShown{token, newest_.time + std::chrono::duration_cast<std::chrono::microseconds>(frame)});
    });
}

void ScanPresenter::handle(const scan_run::Event& event) {
    const ScanRun before = state_;
    const auto [state, effects] = step(state_, event);
    state_ = state;
    workbench_.setScanning(state_.isRunning());
    for (const scan_run::Effect& effect : effects)
        act(effect);
    if (!(before == state_)) {
        emit stateChanged();
        if (needsCamera(before) != needsCamera(state_))
            setActive(isActive_);
    }
}

void ScanPresenter::act(const scan_run::Effect& effect) {
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
                   },
                   [&](scan_run::LightsOff) {
                       if (skin != nullptr)
                           skin->light({});
                   },
                   [&](scan_run::Decode) { decode(); },
                   [&](scan_run::Discard) {
                       pictures_.reset();
                       if (cancelled_)
                           *cancelled_ = true;
                   },
                   [&](const StartTimer& timer) { timer_.start(timer.after); }, [&](StopTimer) { timer_.stop(); }},
        effect);
}

void ScanPresenter::decode() {
    cancelled_ = std::make_shared<std::atomic<bool>>(false);
    RunContext context;
    context.isCancelled = [cancelled = cancelled_] { return cancelled->load(); };
    watcher_.setFuture(QtConcurrent::run([frames = frames_, pictures = std::shared_ptr<const Pictures>(pictures_),
                                          modules = modules(), context = std::move(context)]() mutable {
        return std::make_shared<Outcome>(decodeScan(std::move(frames), std::move(pictures), modules, context));
    }));
}

void ScanPresenter::decodingFinished() {
    if (state_.phase != ScanRun::Phase::Decoding || cancelled_->load())
        return;
    const std::shared_ptr<Outcome> outcome = watcher_.result();
    if (!*outcome) {
        handle(scan_run::Failed{outcome->error()});
        return;
    }
    ScanResult result = **std::move(outcome);
    std::string name;
    if (replaced_ && workbench_.session().findView(*replaced_) != nullptr) {
        name = *replaced_;
        result.view.name = result.view.decoded.name = name;
        workbench_.session().replaceView(std::move(result.view));
    } else {
        name = workbench_.session().addView(std::move(result.view));
    }
    handle(scan_run::Decoded{});
    showView(name);
    emit scanned(name, result.moved_px);
}

}  // namespace skincal
