#pragma once

#include <QAbstractTableModel>

#include "ui/presenters/workbench.h"

namespace skincal {

/// What became of one module in one view.
struct DetectionRow {
    /// From what counts to what can't: sorted by it, they come in this order.
    enum class State {
        Used,
        SetAside,
        Rejected,
        Reflected,
        Ambiguous,
        TooWeak,
        TooBright,
        NotAnLed,
        CameraMoved,
        NeverLit,
        NotVisible,
    };
    ModuleId module;
    State state = State::NotVisible;
    std::optional<Vector2d> pixel;
    std::optional<double> sigma_px;
    std::optional<double> residual_px;  ///< length, against the newest body
    bool isOperatorsWord = false;
    QString reason;
    std::optional<WordReading> reading;  ///< of its spot, or of what came nearest to being it, in pictures
};

/// All modules in a view: sortable by every column, numbers as numbers (Qt::UserRole).
class DetectionModel : public QAbstractTableModel {
    Q_OBJECT
  public:
    enum Column { Module, State, Residual, Sigma, Reason, Columns };
    static constexpr int kSortRole = Qt::UserRole;

    explicit DetectionModel(Workbench& workbench, QObject* parent = nullptr);

    void setView(const std::string& view);
    [[nodiscard]] const std::string& view() const { return view_; }

    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
    [[nodiscard]] QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

    [[nodiscard]] const std::vector<DetectionRow>& rows() const { return rows_; }
    [[nodiscard]] std::optional<int> rowOf(ModuleId module) const;

    /// One decision for all of them; undoable as one.
    void reject(const std::vector<ModuleId>& modules, const QString& why = {});
    void accept(const std::vector<ModuleId>& modules);

  private:
    void refresh();

    Workbench& workbench_;
    std::string view_;
    std::vector<DetectionRow> rows_;
};

[[nodiscard]] QString nameOf(DetectionRow::State state);
/// What it means and what mends it, in a sentence.
[[nodiscard]] QString meaningOf(DetectionRow::State state);

}  // namespace skincal
