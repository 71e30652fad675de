#include "ui/presenters/views_presenter.h"

#include <algorithm>
#include <map>
#include <set>

#include "ui/texts/sentences.h"

namespace skincal {

ViewsPresenter::ViewsPresenter(Workbench& workbench, QObject* parent) : QObject(parent), workbench_(workbench) {
    const Session& session = workbench.session();
    for (const auto signal : {&Session::viewsChanged, &Session::decisionsChanged, &Session::solutionChanged,
                              &Session::guidanceChanged, &Session::skinChanged})
        connect(&session, signal, this, &ViewsPresenter::refresh);
    refresh();
}

void ViewsPresenter::refresh() {
    Session& session = workbench_.session();
    patches_.clear();
    views_.clear();
    std::map<ModuleId, PatchId> patchOf;
    std::map<PatchId, std::set<std::string>> seen;
    if (session.solution()) {
        for (const BodyPatch& patch : session.solution()->body.patches) {
            patches_.push_back({patch.id, patch.modules.size(), patch.T_body_patch.has_value(), {}});
            for (const ModuleId module : patch.modules)
                patchOf[module] = patch.id;
        }
    }
    for (const ScannedView& view : session.measured().views) {
        ViewState state;
        state.name = view.name;
        state.found = view.decoded.found.size();
        state.isDropped = session.decisions().droppedViews.contains(view.name);
        if (session.solution()) {
            for (const BodyView& solved : session.solution()->body.views) {
                if (solved.name == view.name) {
                    state.isPlaced = solved.T_body_camera.has_value();
                    state.residual_px = solved.residual_rms_px;
                }
            }
        }
        if (!state.isDropped) {
            for (const LedDetection& detection : view.decoded.found) {
                if (const auto patch = patchOf.find(detection.module); patch != patchOf.end())
                    seen[patch->second].insert(view.name);
            }
        }
        views_.push_back(std::move(state));
    }
    for (PatchState& patch : patches_)
        patch.views.assign(seen[patch.patch].begin(), seen[patch.patch].end());
    emit changed();
}

const NextView* ViewsPresenter::next() const {
    const auto& guidance = workbench_.session().guidance();
    return guidance && !guidance->views.empty() ? &guidance->views.front() : nullptr;
}

std::optional<Isometry3d> ViewsPresenter::target() const {
    const NextView* view = next();
    return view != nullptr ? std::optional(view->T_r_v) : std::nullopt;
}

bool ViewsPresenter::isEnough() const {
    Session& session = workbench_.session();
    return session.solution() && !session.isStale() && !needsViews(*session.solution()) && !patches_.empty() &&
           std::all_of(patches_.begin(), patches_.end(), [](const PatchState& patch) { return patch.isPlaced; });
}

QString ViewsPresenter::instruction() const {
    Session& session = workbench_.session();
    if (views_.empty())
        return tr("Scan a first view: at least one patch should be well in the picture.");
    const auto missing =
        std::count_if(patches_.begin(), patches_.end(), [](const PatchState& patch) { return !patch.isPlaced; });
    if (isEnough())
        return tr("Enough views: every patch is placed, and seen from more than one side.");
    if (const NextView* view = next()) {
        const QString where = said(view->words);
        return missing > 0 ? tr("%n patches are not placed yet.", nullptr, static_cast<int>(missing)) + u' ' + where
                           : where;
    }
    if (session.isSolving())
        return tr("Working out where the camera should stand next …");
    if (missing > 0)
        return tr("Show the missing patches together with one that is placed.");
    return tr("All patches are placed. Look at them from further sides.");
}

QString ViewsPresenter::reason() const {
    const NextView* view = next();
    if (view == nullptr)
        return {};
    const QString gain = tr("The place of the worst module among the others is then known to %1 instead of %2 mm.")
                             .arg(1e3 * view->gain.worstAfter, 0, 'f', 2)
                             .arg(1e3 * view->gain.worstBefore, 0, 'f', 2);
    if (!isEnough())
        return gain;
    constexpr double kWorthAWalk = 0.9;
    if (view->gain.worstAfter > kWorthAWalk * view->gain.worstBefore)
        return tr("One more would hardly make it more exact.");
    return tr("One more makes it more exact: %1. %2").arg(said(view->words), gain);
}

bool ViewsPresenter::goesToTarget() const {
    return target() && std::all_of(patches_.begin(), patches_.end(), [](const PatchState& p) { return p.isPlaced; });
}

void ViewsPresenter::moveCamera() {
    const RigHands* hands = workbench_.handsOnSkin();
    if (hands == nullptr)
        return;
    const auto& solution = workbench_.session().solution();
    if (goesToTarget() && solution) {
        for (const BodyModule& module : solution->body.modules) {
            if (!module.T_body_module)
                continue;
            hands->moveCamera(module.id, module.T_body_module->inverse() * *target());
            return;
        }
    }
    hands->moveCameraOn();
}

}  // namespace skincal
