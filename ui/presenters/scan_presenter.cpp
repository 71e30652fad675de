#include "ui/presenters/scan_presenter.h"

#include <QtConcurrent/QtConcurrentRun>

#include "ui/presenters/camera_words.h"
#include "ui/texts/sentences.h"

namespace skincal {

bool fitIntoMemory(std::size_t pictures, const cv::Mat& picture) {
    constexpr std::size_t kMost = std::size_t{2} << 30U;  // bytes; some 2,300 grey pictures of 1280 x 720
    return pictures * picture.total() * picture.elemSize() <= kMost;
}

ScanPresenter::ScanPresenter(Workbench& workbench, QObject* parent)
    : QObject(parent), workbench_(workbench), detections_(workbench), series_(workbench) {
    connect(&workbench, &Workbench::cameraChosen, this, &ScanPresenter::attachCamera);
    connect(&workbench, &Workbench::skinReadyChanged, this, &ScanPresenter::stateChanged);
    connect(&workbench.session(), &Session::decisionsChanged, this, &ScanPresenter::stateChanged);
    connect(&workbench.session(), &Session::skinChanged, this, &ScanPresenter::countPictures);
    connect(&workbench.session(), &Session::opened, this, [this] {
        if (const auto& views = workbench_.session().measured().views; !views.empty())
            showView(views.back().name);  // what was opened is to be looked at
    });
    countPictures();
    connect(&series_, &PictureSeries::runningChanged, &workbench, &Workbench::setScanning);
    connect(&series_, &PictureSeries::stateChanged, this, &ScanPresenter::seriesChanged);
    connect(&series_, &PictureSeries::kept, this, [this](std::size_t frame) {
        if (frame < firstLook_)
            watcher_.add(series_.pictureOf(frame));
    });
    connect(&series_, &PictureSeries::complete, this, &ScanPresenter::decode);
    connect(&series_, &PictureSeries::discarded, this, &ScanPresenter::discard);
    connect(&watcher_, &SpotWatcher::changed, this, &ScanPresenter::spotsChanged);
    connect(&decoding_, &QFutureWatcherBase::finished, this, &ScanPresenter::decodingFinished);
    if (workbench.camera() != nullptr)
        attachCamera();
}

ScanPresenter::~ScanPresenter() {
    if (cancelled_)
        *cancelled_ = true;
    decoding_.waitForFinished();
}

QString ScanPresenter::obstacle() const {
    if (!workbench_.isSkinReady())
        return tr("The skin is not connected.");
    if (workbench_.camera() == nullptr)
        return tr("No camera is chosen.");
    if (!workbench_.session().decisions().camera)
        return tr("The camera's intrinsics are not known.");
    if (isWaitingForPicture())
        return tr("The camera gives no pictures yet.");
    const CameraModel& camera = *workbench_.session().decisions().camera;
    if (newest_.image.cols != camera.width || newest_.image.rows != camera.height)
        return tr("The intrinsics are for %1 × %2 pixels, the camera gives %3 × %4.")
            .arg(camera.width)
            .arg(camera.height)
            .arg(newest_.image.cols)
            .arg(newest_.image.rows);
    if (!fitIntoMemory(picturesOfAScan_, newest_.image))
        return tr("One at a time that is %n pictures, more than fit into the memory: scan by words.", nullptr,
                  static_cast<int>(picturesOfAScan_));
    return {};
}

void ScanPresenter::start(const std::optional<std::string>& replaced) {
    if (isBusy())
        return;
    replaced_ = replaced;
    isStartDue_ = isCameraRunning_ && isWaitingForPicture();
    if (!obstacle().isEmpty())
        return;
    // Words change from scan to scan: what two modules that look alike confuse in one view they don't in the next.
    const std::uint64_t seed = std::max<std::uint64_t>(scans_, workbench_.session().measured().views.size());
    scans_ = seed + 1;
    LitSets lit = scanOf(code_, modules(), seed);
    firstLook_ = lit.size();
    further_.emplace(seed);
    result_.reset();
    isKept_ = false;
    watcher_.begin(modules(), lit);
    series_.start(std::move(lit));
}

std::vector<ModuleId> ScanPresenter::modules() const {
    std::vector<ModuleId> modules;
    for (const SkinModule& module : workbench_.session().measured().skin.modules)
        modules.push_back(module.id);
    return modules;
}

void ScanPresenter::countPictures() {
    picturesOfAScan_ = scanOf(code_, modules(), 0).size();
}

void ScanPresenter::setCode(ScanCode code) {
    code_ = code;
    countPictures();
    emit stateChanged();
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
    // While pictures are decoded, too: a further look may follow.
    const bool needed = active || series_.isBusy();
    if (camera == nullptr || needed == isCameraRunning_)
        return;
    isCameraRunning_ = needed;
    isStartDue_ = false;
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
    connect(camera, &FrameSource::frameArrived, this, [this](const CameraFrame& frame) {
        newest_ = frame;
        // What comes after the camera was stopped is late.
        const bool isFirst = isCameraRunning_ && !std::exchange(isPictureNew_, true);
        emit pictureChanged();
        if (isFirst && std::exchange(isStartDue_, false))
            start(replaced_);
        else if (isFirst)
            emit stateChanged();
    });
    connect(camera, &FrameSource::failed, this, [this](const QString& why) {
        newest_ = {};
        isCameraRunning_ = false;
        emit cameraFailed(failureWords(*workbench_.camera(), why));
        emit pictureChanged();
    });
    // Plugged in again, it goes on where it is looked at.
    connect(camera, &FrameSource::returned, this, [this] { setActive(isActive_); });
    setActive(isActive_);
}

void ScanPresenter::seriesChanged() {
    emit stateChanged();
    if (std::exchange(neededCamera_, series_.isBusy()) != series_.isBusy())
        setActive(isActive_);
}

const std::vector<ModuleId>& ScanPresenter::wanted() const {
    static const std::vector<ModuleId> kNobody;
    return further_ && isBusy() ? further_->wanted() : kNobody;
}

void ScanPresenter::discard() {
    if (cancelled_)
        *cancelled_ = true;
    std::optional<ScanResult> result = std::exchange(result_, std::nullopt);
    // What breaks off a further look takes nothing from those before it; but another skin's pictures are nobody's.
    const bool isOfThisSkin = state().fault != ScanRun::Fault::OtherSkin;
    isKept_ = result && isOfThisSkin && !result->view.decoded.found.empty();
    if (isKept_)
        deliver(*std::move(result));
    else
        watcher_.clear();
}

void ScanPresenter::decode() {
    cancelled_ = std::make_shared<std::atomic<bool>>(false);
    RunContext context;
    context.isCancelled = [cancelled = cancelled_] { return cancelled->load(); };
    std::optional<ViewDetections> before;
    if (result_)
        before = result_->view.decoded;
    decoding_.setFuture(QtConcurrent::run([taken = series_.taken(), modules = modules(), before = std::move(before),
                                           context = std::move(context)]() mutable {
        try {
            return std::make_shared<Outcome>(
                decodeScan(std::move(taken.frames), std::move(taken.pictures), modules, context, before));
        } catch (const std::exception& error) {
            return std::make_shared<Outcome>(tl::unexpected(Sentence::saying("internal error: {}", error.what())));
        }
    }));
}

void ScanPresenter::decodingFinished() {
    if (state().phase != ScanRun::Phase::Decoding || cancelled_->load())
        return;
    const std::shared_ptr<Outcome> outcome = decoding_.result();
    if (!*outcome) {
        series_.fail(ScanRun::Fault::NotDecoded, said(outcome->error()));
        return;
    }
    if (looksAgain_) {
        if (const auto look = further_->next((*outcome)->view.decoded)) {
            result_ = **std::move(outcome);
            series_.extend(*look);
            return;
        }
    }
    result_.reset();
    series_.finish();
    deliver(**std::move(outcome));
}

void ScanPresenter::deliver(ScanResult result) {
    result.view.scan = {result.moved_px, watcher_.spots().size()};
    std::string name;
    if (replaced_ && workbench_.session().findView(*replaced_) != nullptr) {
        name = *replaced_;
        result.view.name = result.view.decoded.name = name;
        workbench_.session().replaceView(std::move(result.view));
    } else {
        name = workbench_.session().addView(std::move(result.view));
    }
    showView(name);
    emit scanned(name, result.moved_px, watcher_.spots().size());
}

}  // namespace skincal
