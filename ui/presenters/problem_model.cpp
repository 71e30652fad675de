#include "ui/presenters/problem_model.h"

#include <algorithm>

#include "ui/presenters/camera_words.h"
#include "ui/texts/sentences.h"

namespace skincal {
namespace {

using Severity = Problem::Severity;

/// A camera that stands moves by less than this between two pictures: noise.
constexpr double kMoved_px = 1.0;
constexpr std::size_t kFewSpots = 6;  // of fewer, stray ones may be most

constexpr qsizetype kNamed = 8;  // more make no sentence

QString numbersOf(const std::vector<ModuleId>& modules) {
    QStringList numbers;
    for (const ModuleId module : modules) {
        if (numbers.size() == kNamed) {
            numbers << QStringLiteral("…");
            break;
        }
        numbers << QString::number(module.value);
    }
    return numbers.join(QStringLiteral(", "));
}

/// By their neighbours, whom the operator can find; by numbers of the network where nobody knows them.
QString namesOf(const std::vector<SilentModule>& silent) {
    QStringList names;
    for (const SilentModule& one : silent) {
        if (names.size() == kNamed) {
            names << QStringLiteral("…");
            break;
        }
        names << (one.beside.empty() ? ProblemModel::tr("number %1 of the network").arg(one.number)
                                     : ProblemModel::tr("beside module %1").arg(numbersOf(one.beside)));
    }
    return names.join(QStringLiteral("; "));
}

Step stepOf(Shortfall::Kind kind) {
    switch (kind) {
        case Shortfall::Kind::GravityMissing:
        case Shortfall::Kind::PosesAlike:
            return Step::Pose;
        case Shortfall::Kind::ModulesHidden:
            return Step::Scan;
        case Shortfall::Kind::ScaleFromLinksOnly:
        case Shortfall::Kind::Undetermined:
            return Step::Result;
        default:
            return Step::Views;
    }
}

Step stepOf(const Finding& finding) {
    switch (finding.kind) {
        case Finding::Kind::WrongLink:
        case Finding::Kind::WrongTemplate:
            return Step::Connect;
        case Finding::Kind::ShakenPose:
        case Finding::Kind::NoisyAccelerometer:
            return Step::Pose;
        case Finding::Kind::BumpedView:
        case Finding::Kind::UnsteadyView:
            return Step::Scan;
        default:
            return Step::Result;
    }
}

Problem problemOf(const WiringFault& fault) {
    switch (fault.kind) {
        case WiringFault::Kind::NoLink:
            return {Severity::Warning,
                    Step::Connect,
                    ProblemModel::tr("Module %1 is linked to no other").arg(numbersOf(fault.modules)),
                    fault.modules,
                    {}};
        case WiringFault::Kind::SelfLink:
            return {Severity::Warning,
                    Step::Connect,
                    ProblemModel::tr("Module %1 reports itself as its neighbour").arg(numbersOf(fault.modules)),
                    fault.modules,
                    {}};
        default:
            return {Severity::Warning,
                    Step::Connect,
                    ProblemModel::tr("Two links claim one port of modules %1").arg(numbersOf(fault.modules)),
                    fault.modules,
                    {}};
    }
}

void addSolution(const Solution& solution, std::vector<Problem>& problems) {
    for (const Finding& finding : solution.body.quality.findings)
        problems.push_back({Severity::Warning, stepOf(finding), saidAlone(finding.text), finding.modules,
                            finding.view.value_or(std::string()), finding.pose.value_or(-1)});
    for (const Shortfall& shortfall : solution.shortfalls) {
        const Step step = stepOf(shortfall.kind);
        // Before the first view all patches are unseen: that is no problem, but the next step.
        if (step == Step::Views && solution.body.views.empty())
            continue;
        problems.push_back({Severity::Note, step, saidAlone(shortfall.text), shortfall.modules,
                            shortfall.views.empty() ? std::string() : shortfall.views.front()});
    }
}

}  // namespace

ProblemModel::ProblemModel(Workbench& workbench, const ConnectPresenter& connection, const ScanPresenter& scan,
                           QObject* parent)
    : QAbstractListModel(parent), workbench_(workbench), connection_(connection), scan_(scan) {
    const Session& session = workbench.session();
    for (const auto signal :
         {&Session::skinChanged, &Session::viewsChanged, &Session::decisionsChanged, &Session::solutionChanged})
        connect(&session, signal, this, &ProblemModel::refresh);
    connect(&connection, &ConnectPresenter::stateChanged, this, &ProblemModel::refresh);
    connect(&scan, &ScanPresenter::stateChanged, this, &ProblemModel::refresh);
    connect(&scan, &ScanPresenter::cameraFailed, this, [this](const QString& why) {
        cameraFailure_ = why;
        refresh();
    });
    connect(&scan, &ScanPresenter::pictureChanged, this, [this] {
        if (!cameraFailure_.isEmpty() && !scan_.picture().empty()) {
            cameraFailure_.clear();
            refresh();
        }
    });
    connect(&workbench, &Workbench::cameraChosen, this, [this] {
        cameraFailure_.clear();
        connect(workbench_.camera(), &FrameSource::abilitiesChanged, this, &ProblemModel::refresh);
        refresh();
    });
    refresh();
}

int ProblemModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : static_cast<int>(problems_.size());
}

QVariant ProblemModel::data(const QModelIndex& index, int role) const {
    if (!checkIndex(index, CheckIndexOption::IndexIsValid))
        return {};
    const Problem& problem = problemAt(index.row());
    switch (role) {
        case Qt::DisplayRole:
        case Qt::ToolTipRole:
            return problem.text;
        case SeverityRole:
            return static_cast<int>(problem.severity);
        case StepRole:
            return nameOf(problem.step);
        default:
            return {};
    }
}

void ProblemModel::setNotice(const QString& text, Step step) {
    notice_ = Problem{Severity::Error, step, text, {}, {}};
    refresh();
}

void ProblemModel::clearNotice() {
    if (notice_) {
        notice_.reset();
        refresh();
    }
}

void ProblemModel::setKept(const QString& directory, const QString& when) {
    kept_.reset();
    if (!directory.isEmpty()) {
        kept_ = Problem{Severity::Note,
                        Step::Connect,
                        tr("Work of %1 was not saved: click here to go on with it").arg(when),
                        {},
                        {}};
        kept_->directory = directory;
    }
    refresh();
}

void ProblemModel::collect(std::vector<Problem>& problems) const {
    Session& session = workbench_.session();
    if (notice_)
        problems.push_back(*notice_);
    if (kept_)
        problems.push_back(*kept_);
    if (connection_.state().phase == Connection::Phase::Lost)
        problems.push_back({Severity::Error, Step::Connect, connection_.why(), {}, {}});
    if (const auto silent = workbench_.isSkinReady() ? workbench_.skin()->silent() : std::vector<SilentModule>();
        !silent.empty()) {
        Problem problem{Severity::Warning,
                        Step::Connect,
                        tr("%n modules did not answer: %1", nullptr, static_cast<int>(silent.size())),
                        {},
                        {}};
        problem.text = problem.text.arg(namesOf(silent));
        for (const SilentModule& one : silent)
            problem.modules.insert(problem.modules.end(), one.beside.begin(), one.beside.end());
        problems.push_back(std::move(problem));
    }
    if (const auto& gone = connection_.gone(); workbench_.isSkinReady() && !gone.empty()) {
        Problem problem{Severity::Warning,
                        Step::Connect,
                        tr("%n modules that were there do not answer any more: %1. Connect again to go on without them",
                           nullptr, static_cast<int>(gone.size()))
                            .arg(numbersOf(gone)),
                        {},
                        {}};
        problem.modules = gone;
        problems.push_back(std::move(problem));
    }
    if (const auto& dark = connection_.dark(); workbench_.isSkinReady() && !dark.empty()) {
        Problem problem{
            Severity::Warning,
            Step::Connect,
            tr("%n modules did not show the last light they were told to: %1", nullptr, static_cast<int>(dark.size()))
                .arg(numbersOf(dark)),
            {},
            {}};
        problem.modules = dark;
        problems.push_back(std::move(problem));
    }
    if (workbench_.isSkinReady() && connection_.strangers() > 0)
        problems.push_back({Severity::Note,
                            Step::Connect,
                            tr("%n modules have come that were not there before. Connect again to take them in",
                               nullptr, static_cast<int>(connection_.strangers())),
                            {},
                            {}});
    if (!cameraFailure_.isEmpty())
        problems.push_back({Severity::Error, Step::Camera, cameraFailure_, {}, {}});
    if (workbench_.camera() != nullptr && mayBrightnessChange(workbench_.camera()->controls()))
        problems.push_back({Severity::Note, Step::Camera, brightnessWords(), {}, {}});
    if (scan_.state().phase == ScanRun::Phase::Failed)
        problems.push_back({Severity::Error, Step::Scan, tr("The scan was broken off: %1").arg(scan_.why()), {}, {}});
    if (!session.failure().empty())
        problems.push_back({Severity::Error, Step::Result, saidAlone(session.failure()), {}, {}});
    for (const WiringFault& fault : wiringFaults(session.measured().skin))
        problems.push_back(problemOf(fault));
    for (const ScannedView& view : session.measured().views) {
        if (!view.scan || session.decisions().droppedViews.contains(view.name))
            continue;
        const ScannedView::Scan& scan = *view.scan;
        const std::size_t found = view.decoded.found.size();
        if (scan.shone >= kFewSpots && 2 * found < scan.shone)
            problems.push_back({Severity::Warning,
                                Step::Scan,
                                tr("%1: %2 spots shone, only %3 could be told apart: scan it again, at rest and not "
                                   "too bright")
                                    .arg(view.name.c_str())
                                    .arg(scan.shone)
                                    .arg(found),
                                {},
                                view.name});
        if (scan.moved_px > kMoved_px)
            problems.push_back({Severity::Warning,
                                Step::Scan,
                                tr("The camera moved by %1 px while %2 was scanned: scan it again")
                                    .arg(scan.moved_px, 0, 'f', 1)
                                    .arg(view.name.c_str()),
                                {},
                                view.name});
    }
    if (session.solution())
        addSolution(*session.solution(), problems);
}

void ProblemModel::refresh() {
    std::vector<Problem> problems;
    collect(problems);
    std::stable_sort(problems.begin(), problems.end(),
                     [](const Problem& a, const Problem& b) { return a.severity > b.severity; });
    const auto same = [](const Problem& a, const Problem& b) {
        return a.text == b.text && a.severity == b.severity && a.step == b.step;
    };
    if (std::equal(problems.begin(), problems.end(), problems_.begin(), problems_.end(), same)) {
        problems_ = std::move(problems);
        return;
    }
    beginResetModel();
    problems_ = std::move(problems);
    endResetModel();
}

}  // namespace skincal
