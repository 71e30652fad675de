#include "app/guided_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <QProcess>
#include <algorithm>
#include <cstdio>

#include "ui/presenters/camera_words.h"

namespace skincal {
namespace {

constexpr int kScanTries = 3;

/// How the light was timed, for the log of who looks for what is slow.
QString timingOf(const ScanRun& run) {
    if (!run.timing)
        return QStringLiteral("light could not be timed, so pictures were taken one by one");
    const auto ms = [](ScanRun::Time time) { return std::chrono::round<std::chrono::milliseconds>(time).count(); };
    if (!run.plan)
        return QStringLiteral(
                   "light shows %1 ± %2 ms after its command, but patterns could not follow each other at the camera's "
                   "rate, so pictures were taken one by one")
            .arg(ms(run.timing->latency))
            .arg(ms(run.timing->uncertainty));
    return QStringLiteral(
               "by the pictures' times light shows %1 ± %2 ms after its command (jitter %3 ms); "
               "each pattern was lit for %4 pictures")
        .arg(ms(run.timing->latency))
        .arg(ms(run.timing->uncertainty))
        .arg(ms(run.timing->jitter))
        .arg(run.plan->periods);
}

QString numbers(const Vector3d& v) {
    return QStringLiteral("%1 %2 %3").arg(v.x()).arg(v.y()).arg(v.z());
}

}  // namespace

GuidedRun::GuidedRun(Workbench& workbench, GuidedRunOptions options)
    : workbench_(workbench),
      options_(std::move(options)),
      connect_(workbench),
      poses_(workbench),
      scan_(workbench),
      skin_(workbench.session().measured().skin),
      skinGone_(
          options_.absence, [this] { connect_.connectSkin(); },
          [this] {
              stop(QStringLiteral("the skin did not come back within %1 s. %2")
                       .arg(options_.absence.count())
                       .arg(skinGone_.why()));
          }),
      cameraGone_(
          options_.absence, [this] { scan_.setActive(true); },
          [this] {
              stop(QStringLiteral("the camera did not come back within %1 s. %2")
                       .arg(options_.absence.count())
                       .arg(cameraGone_.why()));
          }),
      input_(fileno(stdin), QSocketNotifier::Read),
      patience_(this) {
    scan_.setCode(options_.code);
    input_.setEnabled(false);
    patience_.setSingleShot(true);
    connect(&patience_, &QTimer::timeout, this, [this] {
        if (step_ != Step::Posing)
            return stop(QStringLiteral("the camera gave no pictures"));
        stop(poses_.isKnownPose() ? QStringLiteral("the body rests as in a pose that is there already")
                                  : QStringLiteral("the body did not come to rest in a new pose"));
    });
    connect(&poses_, &PosePresenter::sampled, this, [this] {
        if (isPoseDue_ && poses_.isKnownPose() && !std::exchange(isToldKnown_, true))
            say(QStringLiteral("It rests as in a pose that is there already. Turn it further, within %1 s")
                    .arg(options_.patience.count()));
    });
    connect(&input_, &QSocketNotifier::activated, this, [this] {
        std::array<char, 256> bytes{};
        const auto count = ::read(fileno(stdin), bytes.data(), bytes.size());
        if (count <= 0)
            return stop(QStringLiteral("nobody is at the keyboard: give --on-pose and --on-view"));
        if (std::find(bytes.begin(), bytes.begin() + count, '\n') == bytes.begin() + count)
            return;
        input_.setEnabled(false);
        if (const auto then = std::exchange(afterEnter_, {}))
            then();
    });
    connect(&connect_, &ConnectPresenter::stateChanged, this, &GuidedRun::connectionChanged);
    connect(&poses_, &PosePresenter::captured, this, &GuidedRun::poseCaptured);
    connect(&scan_, &ScanPresenter::scanned, this, &GuidedRun::viewScanned);
    connect(&scan_, &ScanPresenter::pictureChanged, this, &GuidedRun::pictureChanged);
    connect(&scan_, &ScanPresenter::cameraFailed, this, &GuidedRun::cameraFailed);
    connect(&scan_, &ScanPresenter::stateChanged, this, [this] {
        // It also comes where something else changes: a failure counts once, where it is new.
        const bool hasFailed = scan_.state().phase == ScanRun::Phase::Failed;
        if (!std::exchange(isFailed_, hasFailed) && hasFailed && step_ == Step::Scanning)
            scanFailed();
    });
    connect(&workbench.session(), &Session::fileFailed, this, &GuidedRun::stop);
    connect(&workbench.session(), &Session::saved, this, [this] {
        if (step_ == Step::Done && !workbench_.session().isModified())
            emit finished({});
    });
}

void GuidedRun::say(const QString& text) const {
    fmt::print(stderr, "{}\n", text.toStdString());
}

void GuidedRun::stop(const QString& why) {
    if (step_ == Step::Done)
        return;
    step_ = Step::Done;
    patience_.stop();
    skinGone_.end();
    cameraGone_.end();
    poses_.setActive(false);
    scan_.setActive(false);
    emit finished(why);
}

void GuidedRun::begin() {
    say(QStringLiteral("Connecting to %1").arg(workbench_.skinOffers.front().name));
    workbench_.chooseSkin(0);
    connect_.connectSkin();
}

void GuidedRun::connectionChanged() {
    using Phase = Connection::Phase;
    const Phase phase = connect_.state().phase;
    if (step_ == Step::Connecting) {
        if (phase == Phase::Connected)
            connected();
        else if (phase == Phase::Lost)
            stop(connect_.why());
    } else if (step_ != Step::Done) {
        if (phase == Phase::Lost)
            beginWaiting(skinGone_, connect_.why());
        else if (phase == Phase::Connected && skinGone_.end())
            skinIsBack();
    }
}

void GuidedRun::skinIsBack() {
    // Nothing was written since: what is in the recording is still of the skin before.
    if (!sameSkin(skin_, workbench_.session().measured().skin))
        return stop(QStringLiteral("another skin was connected in the place of the one that was lost"));
    say(QStringLiteral("The skin is there again"));
    goOn();
}

void GuidedRun::cameraFailed(const QString& why) {
    if (step_ == Step::Camera)
        stop(why);
    else if (step_ == Step::Scanning)
        beginWaiting(cameraGone_, why);
}

void GuidedRun::pictureChanged() {
    if (scan_.picture().empty())
        return;
    if (cameraGone_.end()) {
        say(QStringLiteral("The camera gives pictures again"));
        goOn();
    }
    if (step_ != Step::Camera || !workbench_.isSkinReady())
        return;
    if (const QString obstacle = scan_.obstacle(); !obstacle.isEmpty())
        return stop(obstacle);
    patience_.stop();
    if (captured_ < options_.poses) {
        scan_.setActive(false);
        return beginPoses();
    }
    step_ = Step::Scanning;
    nextView();
}

void GuidedRun::noteControls() {
    const std::vector<ControlState> controls = workbench_.camera()->controls();
    if (areControlsTold_ || !mayBrightnessChange(controls))
        return;
    areControlsTold_ = true;
    say(QStringLiteral("%1. %2").arg(brightnessWords(), controlWords(controls)));
}

void GuidedRun::beginWaiting(Absence& absence, const QString& why) {
    if (!absence.note(why))
        return;
    patience_.stop();
    say(why);
    say(QStringLiteral("Waiting until it is there again, for %1 s at most").arg(options_.absence.count()));
}

void GuidedRun::goOn() {
    if (skinGone_.isLasting() || cameraGone_.isLasting())
        return;
    if (step_ == Step::Camera || (step_ == Step::Posing && isPoseDue_))
        patience_.start(options_.patience);
    if (step_ != Step::Scanning || !isScanDue_)
        return;
    if (const QString obstacle = scan_.obstacle(); !obstacle.isEmpty())
        return stop(obstacle);
    isScanDue_ = false;
    say(QStringLiteral("View %1 of %2: scanning").arg(scanned_ + 1).arg(options_.views));
    scan_.start();
}

void GuidedRun::connected() {
    const Measured& measured = workbench_.session().measured();
    if (!skin_.modules.empty() && !sameSkin(skin_, measured.skin))
        return stop(QStringLiteral("the recording is of another skin"));
    skin_ = measured.skin;
    say(QStringLiteral("%1 modules, %2 links").arg(measured.skin.modules.size()).arg(measured.skin.links.size()));
    if (const auto& gone = connect_.gone(); !gone.empty()) {
        QStringList numbers;
        for (const ModuleId module : gone)
            numbers << QString::number(module.value);
        say(QStringLiteral("%1 of the recording's modules do not answer: %2")
                .arg(gone.size())
                .arg(numbers.join(QStringLiteral(", "))));
    }
    captured_ = static_cast<int>(posesOf(measured, workbench_.session().decisions()).size());
    scanned_ = static_cast<int>(measured.views.size());
    if (captured_ > 0)
        say(QStringLiteral("%1 poses and %2 views are there already").arg(captured_).arg(scanned_));
    save();
    // That a camera gives no pictures, or of another size than its lens, is known before a body was turned eight times.
    if (scanned_ < options_.views)
        startCamera();
    else
        beginPoses();
}

void GuidedRun::beginPoses() {
    step_ = Step::Posing;
    if (captured_ >= options_.poses)
        return endPoses();
    poses_.setAutomatic(true);
    poses_.setActive(true);
    if (captured_ > 0)
        return nextPose();
    say(QStringLiteral("Pose 1 of %1: let the body rest").arg(options_.poses));
    awaitPose();
}

void GuidedRun::nextPose() {
    std::vector<std::pair<QString, QString>> environment{{QStringLiteral("SKINCAL_POSE"), QString::number(captured_)}};
    if (const auto target = poses_.target(); target && poses_.reference()) {
        environment.emplace_back(QStringLiteral("SKINCAL_UP"), numbers(*target));
        environment.emplace_back(QStringLiteral("SKINCAL_MODULE"), QString::number(poses_.reference()->value));
    }
    isToldKnown_ = false;
    say(QStringLiteral("Pose %1 of %2: turn the body over and let it rest").arg(captured_ + 1).arg(options_.poses));
    if (!options_.onPose.isEmpty())
        prepare(options_.onPose, {}, std::move(environment), [this] { awaitPose(); });
}

void GuidedRun::awaitPose() {
    isPoseDue_ = true;
    goOn();
}

void GuidedRun::poseCaptured(int /*pose*/) {
    if (step_ != Step::Posing)
        return;
    patience_.stop();
    isPoseDue_ = false;
    save();
    if (++captured_ < options_.poses)
        nextPose();
    else
        endPoses();
}

void GuidedRun::endPoses() {
    poses_.setActive(false);
    if (scanned_ >= options_.views) {
        step_ = Step::Done;
        save();
        return;
    }
    startCamera();
}

void GuidedRun::startCamera() {
    step_ = Step::Camera;
    say(QStringLiteral("Starting the camera"));
    if (workbench_.camera() == nullptr) {
        workbench_.chooseCamera(0);
        connect(workbench_.camera(), &FrameSource::abilitiesChanged, this, &GuidedRun::noteControls);
    }
    goOn();
    scan_.setActive(true);
}

void GuidedRun::nextView() {
    tries_ = 0;
    if (scanned_ == 0)
        return startScan();
    const QString request =
        QStringLiteral(
            "View %1 of %2: move the camera so that it sees modules of the last view and new ones, and press "
            "Enter")
            .arg(scanned_ + 1)
            .arg(options_.views);
    prepare(options_.onView, request, {{QStringLiteral("SKINCAL_VIEW"), QString::number(scanned_)}},
            [this] { startScan(); });
}

void GuidedRun::startScan() {
    isScanDue_ = true;
    goOn();
}

void GuidedRun::scanFailed() {
    using Fault = ScanRun::Fault;
    // What looks before this one found has become a view: nothing is to be scanned anew.
    if (scan_.isKept())
        return;
    const Fault fault = scan_.state().fault;
    if (fault == Fault::SkinGone || fault == Fault::CameraFailed) {
        // Nobody's fault but the cable's: it costs no try. That it is waited for is said by who misses it.
        isScanDue_ = true;
        return;
    }
    if (++tries_ == kScanTries)
        return stop(QStringLiteral("the scan failed: ") + scan_.why());
    say(QStringLiteral("The scan failed: %1. Again.").arg(scan_.why()));
    QTimer::singleShot(2000, this, [this] { startScan(); });
}

void GuidedRun::viewScanned(const std::string& view) {
    const ScannedView* scanned = workbench_.session().findView(view);
    const std::size_t found = scanned == nullptr ? 0 : scanned->decoded.found.size();
    say(QStringLiteral("View %1 of %2: %3 modules found; %4")
            .arg(scanned_ + 1)
            .arg(options_.views)
            .arg(found)
            .arg(timingOf(scan_.state())));
    ++scanned_;
    if (scanned_ == options_.views) {
        scan_.setActive(false);
        step_ = Step::Done;
    }
    save();
    if (step_ != Step::Done)
        nextView();
}

void GuidedRun::save() {
    workbench_.session().save(options_.directory);
}

void GuidedRun::prepare(const QString& command, const QString& request,
                        std::vector<std::pair<QString, QString>> environment, std::function<void()> then) {
    if (command.isEmpty()) {
        say(request);
        afterEnter_ = std::move(then);
        input_.setEnabled(true);
        return;
    }
    auto* process = new QProcess(this);
    QProcessEnvironment variables = QProcessEnvironment::systemEnvironment();
    for (const auto& [name, value] : environment)
        variables.insert(name, value);
    process->setProcessEnvironment(variables);
    process->setProcessChannelMode(QProcess::ForwardedChannels);
    connect(process, &QProcess::errorOccurred, this,
            [this, command] { stop(QStringLiteral("\"%1\" could not be run").arg(command)); });
    connect(process, &QProcess::finished, this,
            [this, process, command, then = std::move(then)](int code, QProcess::ExitStatus status) {
                process->deleteLater();
                if (status != QProcess::NormalExit || code != 0)
                    stop(QStringLiteral("\"%1\" failed with exit code %2").arg(command).arg(code));
                else
                    then();
            });
    process->start(QStringLiteral("/bin/sh"), {QStringLiteral("-c"), command});
}

}  // namespace skincal
