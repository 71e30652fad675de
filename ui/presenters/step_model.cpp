#include "ui/presenters/step_model.h"

#include <algorithm>

namespace skincal {

QString nameOf(Step step) {
    switch (step) {
        case Step::Connect:
            return StepModel::tr("Connect");
        case Step::Pose:
            return StepModel::tr("Pose the body");
        case Step::Camera:
            return StepModel::tr("Camera");
        case Step::Scan:
            return StepModel::tr("Scan");
        case Step::Views:
            return StepModel::tr("Move the camera");
        case Step::Result:
            return StepModel::tr("Result");
        case Step::Export:
            return StepModel::tr("Export");
        default:
            return StepModel::tr("Live demo");
    }
}

QString sentenceOf(StepReason reason) {
    switch (reason) {
        case StepReason::NoSkin:
            return StepModel::tr("connect a skin first");
        case StepReason::SkinLost:
            return StepModel::tr("the skin can't be reached");
        case StepReason::NoNeighbours:
            return StepModel::tr("no two modules are neighbours");
        case StepReason::NoPoses:
            return StepModel::tr("hold the body still");
        case StepReason::TooFewPoses:
            return StepModel::tr("turn it to further poses");
        case StepReason::PosesAlike:
            return StepModel::tr("poses are too alike");
        case StepReason::NoCamera:
            return StepModel::tr("choose a camera");
        case StepReason::NoPictures:
            return StepModel::tr("waiting for a picture");
        case StepReason::CameraLost:
            return StepModel::tr("the camera gives no pictures");
        case StepReason::NoIntrinsics:
            return StepModel::tr("intrinsics are needed");
        case StepReason::FirstView:
            return StepModel::tr("ready: scan a view");
        case StepReason::NoViews:
            return StepModel::tr("scan a view first");
        case StepReason::PatchesNotPlaced:
            return StepModel::tr("patches are not placed yet");
        case StepReason::FewViews:
            return StepModel::tr("look from further sides");
        case StepReason::ModulesNotPlaced:
            return StepModel::tr("some modules are not placed");
        case StepReason::NotSolved:
            return StepModel::tr("the newest data can't be solved");
        case StepReason::NotTrusted:
            return StepModel::tr("not to be trusted yet");
        case StepReason::Changed:
            return StepModel::tr("the body has changed since");
        case StepReason::Solving:
            return StepModel::tr("being computed");
        default:
            return {};
    }
}

StepModel::StepModel(Workbench& workbench, const ConnectPresenter& connection, const ScanPresenter& scan,
                     QObject* parent)
    : QAbstractListModel(parent), workbench_(workbench), connection_(connection), scan_(scan), states_(stepStates({})) {
    const Session& session = workbench.session();
    for (const auto signal : {&Session::skinChanged, &Session::posesChanged, &Session::viewsChanged,
                              &Session::decisionsChanged, &Session::solutionChanged})
        connect(&session, signal, this, &StepModel::refresh);
    connect(&session, &Session::solvingChanged, this, &StepModel::refresh);
    connect(&connection, &ConnectPresenter::stateChanged, this, &StepModel::refresh);
    connect(&workbench, &Workbench::cameraChosen, this, &StepModel::refresh);
    connect(&scan, &ScanPresenter::cameraFailed, this, [this] {
        isCameraLost_ = true;
        refresh();
    });
    connect(&scan, &ScanPresenter::pictureChanged, this, [this] {
        if (!scan_.picture().empty() && (isCameraLost_ || !hadPictures_)) {
            isCameraLost_ = false;
            refresh();
        }
    });
    refresh();
}

int StepModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : static_cast<int>(kSteps.size());
}

QVariant StepModel::data(const QModelIndex& index, int role) const {
    if (!checkIndex(index, CheckIndexOption::IndexIsValid))
        return {};
    const auto row = static_cast<std::size_t>(index.row());
    switch (role) {
        case Qt::DisplayRole:
            return nameOf(kSteps.at(row));
        case StatusRole:
            return static_cast<int>(states_.at(row).status);
        case ReasonRole:
        case Qt::ToolTipRole:
            return sentenceOf(states_.at(row).reason);
        case Qt::AccessibleTextRole:
            return tr("%1: %2").arg(nameOf(kSteps.at(row)), sentenceOf(states_.at(row).reason));
        default:
            return {};
    }
}

void StepModel::noteExport(std::shared_ptr<const Solution> of) {
    exported_ = std::move(of);
    refresh();
}

Progress StepModel::progress() const {
    Session& session = workbench_.session();
    Progress p;
    p.hasSkin = !session.measured().skin.modules.empty();
    p.isSkinLost = connection_.state().phase == Connection::Phase::Lost;
    p.modules = session.measured().skin.modules.size();
    const auto& links = connection_.links().links();
    p.neighbourLinks = static_cast<std::size_t>(std::count_if(
        links.begin(), links.end(), [](const JudgedLink& link) { return link.kind == LinkKind::Adjacent; }));
    p.poses = posesOf(session.measured(), session.decisions()).size();
    p.hasIntrinsics = session.decisions().camera.has_value();
    p.hasCamera = workbench_.camera() != nullptr;
    p.hasPictures = !scan_.picture().empty();
    p.isCameraLost = isCameraLost_;
    p.views = session.measured().views.size() - session.decisions().droppedViews.size();
    p.isSolving = session.isSolving();
    p.isUnsolved = !session.isSolving() && !session.failure().empty();
    if (const auto& solution = session.solution()) {
        p.hasBody = solution->solved.anyViewPlaced();
        p.patches = solution->body.patches.size();
        p.patchesPlaced = static_cast<std::size_t>(
            std::count_if(solution->body.patches.begin(), solution->body.patches.end(),
                          [](const BodyPatch& patch) { return patch.T_body_patch.has_value(); }));
        p.modulesPlaced = solution->body.quality.modulesPlaced;
        p.isTrusted = solution->body.quality.trust != Trust::NotToBeTrusted;
        p.arePosesAlike =
            std::any_of(solution->shortfalls.begin(), solution->shortfalls.end(),
                        [](const Shortfall& shortfall) { return shortfall.kind == Shortfall::Kind::PosesAlike; });
        p.areViewsFew = needsViews(*solution);
        // Undone, a decision leaves the body as it was exported.
        p.isExportNewest =
            exported_ && !session.isStale() && (exported_ == solution || isSameBody(exported_->body, solution->body));
    }
    p.isExported = exported_ != nullptr;
    return p;
}

void StepModel::refresh() {
    hadPictures_ = !scan_.picture().empty();
    const StepStates states = stepStates(progress());
    if (states == states_)
        return;
    states_ = states;
    emit dataChanged(index(0), index(rowCount() - 1));
    emit changed();
}

}  // namespace skincal
