#pragma once

#include <QAbstractTableModel>

#include "ui/presenters/workbench.h"

namespace skincal {

/// How far what one module read in a pose is from what its patch as a whole read, m/s^2.
struct PoseResidual {
    ModuleId module;
    double length = 0;
};

/// Captured gravity poses, dropped ones included: they can be taken back.
class PoseModel : public QAbstractTableModel {
    Q_OBJECT
  public:
    enum Column { Number, Modules, Nearest, Residual, State, Columns };

    explicit PoseModel(Workbench& workbench, QObject* parent = nullptr);

    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
    [[nodiscard]] QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

    [[nodiscard]] int poseAt(int row) const { return rows_.at(static_cast<std::size_t>(row)).pose; }
    [[nodiscard]] bool isDropped(int row) const { return rows_.at(static_cast<std::size_t>(row)).isDropped; }
    /// Of one pose, the worst first; empty before patches have a shape.
    [[nodiscard]] std::vector<PoseResidual> residualsOf(int pose) const;
    /// Undoable.
    void setDropped(int row, bool dropped);

  private:
    struct Row {
        int pose = 0;
        std::size_t modules = 0;
        std::optional<double> nearest;   ///< rad, to the most similar other pose that counts
        std::optional<double> residual;  ///< m/s^2, rms over the modules
        bool isDropped = false;
    };

    void refresh();

    Workbench& workbench_;
    std::vector<Row> rows_;
};

}  // namespace skincal
