#include "ui/presenters/pose_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/procedure/stillness.h"

namespace skincal {
namespace {

/// Specific force of a module in its patch's frame, its accelerometer's errors taken out as far as they are known.
std::optional<Vector3d> inPatch(const BodyModule& module, const Vector3d& raw) {
    if (!module.T_patch_module || !module.patch)
        return std::nullopt;
    const Vector3d f = module.accelerometer ? module.accelerometer->specificForce(raw) : raw;
    return Vector3d(module.T_patch_module->linear() * f);
}

}  // namespace

PoseModel::PoseModel(Workbench& workbench, QObject* parent) : QAbstractTableModel(parent), workbench_(workbench) {
    const Session& session = workbench.session();
    connect(&session, &Session::posesChanged, this, &PoseModel::refresh);
    // Of all decisions only which poses are dropped shows here.
    connect(&session, &Session::decisionsChanged, this, [this] {
        const std::set<int>& dropped = workbench_.session().decisions().droppedPoses;
        const auto isNews = [&](const Row& row) { return row.isDropped != dropped.contains(row.pose); };
        if (std::any_of(rows_.begin(), rows_.end(), isNews))
            refresh();
    });
    connect(&session, &Session::solutionChanged, this, &PoseModel::refresh);
    refresh();
}

int PoseModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int PoseModel::columnCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : Columns;
}

QVariant PoseModel::data(const QModelIndex& index, int role) const {
    if (!checkIndex(index, CheckIndexOption::IndexIsValid))
        return {};
    const Row& row = rows_[static_cast<std::size_t>(index.row())];
    if (role == Qt::TextAlignmentRole && index.column() != State)
        return static_cast<int>(Qt::AlignRight | Qt::AlignVCenter);
    if (role != Qt::DisplayRole)
        return {};
    switch (index.column()) {
        case Number:
            return row.pose + 1;
        case Modules:
            return static_cast<int>(row.modules);
        case Nearest:
            return row.nearest ? tr("%1°").arg(*row.nearest / kDegree, 0, 'f', 0) : tr("–");
        case Residual:
            return row.residual ? tr("%1 m/s²").arg(*row.residual, 0, 'f', 3) : tr("–");
        case State:
            return row.isDropped ? tr("dropped") : tr("counts");
        default:
            return {};
    }
}

QVariant PoseModel::headerData(int section, Qt::Orientation orientation, int role) const {
    if (orientation != Qt::Horizontal)
        return {};
    if (role == Qt::ToolTipRole && section == Residual)
        return tr(
            "How much modules differ from their patch in this pose. A pose during which the body moved stands out.");
    if (role == Qt::ToolTipRole && section == Nearest)
        return tr("Turn to the most similar pose. Poses that are alike tell little.");
    if (role != Qt::DisplayRole)
        return {};
    switch (section) {
        case Number:
            return tr("Pose");
        case Modules:
            return tr("Modules");
        case Nearest:
            return tr("To nearest");
        case Residual:
            return tr("Residual");
        case State:
            return tr("State");
        default:
            return {};
    }
}

std::vector<PoseResidual> PoseModel::residualsOf(int pose) const {
    Session& session = workbench_.session();
    if (!session.solution())
        return {};
    std::map<ModuleId, const BodyModule*> modules;
    for (const BodyModule& module : session.solution()->body.modules)
        modules[module.id] = &module;
    struct Forces {
        Vector3d sum = Vector3d::Zero();
        std::vector<std::pair<ModuleId, Vector3d>> of;
    };
    std::map<PatchId, Forces> patches;
    for (const GravityReading& reading : session.measured().gravity) {
        const auto found = modules.find(reading.module);
        if (reading.pose != pose || found == modules.end())
            continue;
        if (const auto force = inPatch(*found->second, reading.acceleration)) {
            Forces& patch = patches[*found->second->patch];
            patch.sum += *force;
            patch.of.emplace_back(reading.module, *force);
        }
    }
    std::vector<PoseResidual> residuals;
    for (const auto& [id, patch] : patches) {
        const Vector3d mean = patch.sum / static_cast<double>(patch.of.size());
        for (const auto& [module, force] : patch.of)
            residuals.push_back({module, (force - mean).norm()});
    }
    std::sort(residuals.begin(), residuals.end(),
              [](const PoseResidual& a, const PoseResidual& b) { return a.length > b.length; });
    return residuals;
}

void PoseModel::setDropped(int row, bool dropped) {
    const int pose = poseAt(row);
    const QString text = dropped ? tr("Drop pose %1") : tr("Take pose %1 back");
    workbench_.session().decide(text.arg(pose + 1), [&](Decisions& decisions) {
        if (dropped)
            decisions.droppedPoses.insert(pose);
        else
            decisions.droppedPoses.erase(pose);
    });
}

void PoseModel::refresh() {
    Session& session = workbench_.session();
    std::map<int, std::vector<GravityReading>> byPose;
    for (const GravityReading& reading : session.measured().gravity)
        byPose[reading.pose].push_back(reading);
    std::vector<Row> rows;
    for (const auto& [pose, readings] : byPose) {
        Row row{pose, readings.size(), std::nullopt, std::nullopt, session.decisions().droppedPoses.contains(pose)};
        std::vector<GravityReading> others;
        for (const auto& [other, of] : byPose) {
            if (other != pose && !session.decisions().droppedPoses.contains(other))
                others.insert(others.end(), of.begin(), of.end());
        }
        if (!others.empty())
            row.nearest = angleToNearestPose(others, readings);
        double squares = 0;
        const auto residuals = residualsOf(pose);
        for (const PoseResidual& residual : residuals)
            squares += residual.length * residual.length;
        if (!residuals.empty())
            row.residual = std::sqrt(squares / static_cast<double>(residuals.size()));
        rows.push_back(std::move(row));
    }
    // Whoever has selected a pose keeps it, as long as there are the same.
    const bool isSame = std::equal(rows.begin(), rows.end(), rows_.begin(), rows_.end(),
                                   [](const Row& a, const Row& b) { return a.pose == b.pose; });
    if (isSame) {
        rows_ = std::move(rows);
        if (!rows_.empty())
            emit dataChanged(index(0, 0), index(rowCount() - 1, Columns - 1));
        return;
    }
    beginResetModel();
    rows_ = std::move(rows);
    endResetModel();
}

}  // namespace skincal
