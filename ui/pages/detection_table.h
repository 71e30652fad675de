#pragma once

#include <QWidget>
#include <vector>

#include "core/geometry/ids.h"

class QCheckBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QTableView;

namespace skincal {

class DetectionFilter;
class ScanPresenter;
class SpotCard;
class Workbench;

/// All modules of the view that is shown, or those that are asked for, and of the selected one what decided about it.
/// Detections are accepted and rejected here.
class DetectionTable : public QWidget {
    Q_OBJECT
  public:
    DetectionTable(Workbench& workbench, ScanPresenter& presenter, QWidget* parent = nullptr);

    [[nodiscard]] std::vector<ModuleId> selected() const;
    /// Whatever is filtered, it is shown.
    void select(ModuleId module);
    /// What can be done with the selection.
    void refresh();

  signals:
    void selectionChanged();

  private:
    [[nodiscard]] QWidget* filterRow();
    void setUpTable();
    void countRows();
    void showEvidence();

    std::vector<ModuleId> kept_;  ///< selected, while the table is filled anew
    ScanPresenter& presenter_;
    QPushButton* accept_;
    QPushButton* reject_;
    DetectionFilter* filter_;
    QLineEdit* number_;
    QCheckBox* doubtful_;
    QCheckBox* far_;
    QDoubleSpinBox* limit_;
    QLabel* count_;
    QTableView* table_;
    SpotCard* card_;
};

}  // namespace skincal
