#pragma once

#include <QWidget>
#include <array>
#include <vector>

#include "core/geometry/ids.h"

class QLabel;
class QPushButton;
class QSortFilterProxyModel;
class QTableView;

namespace skincal {

struct WordReading;

class ScanPresenter;
class Workbench;

/// All modules of the view that is shown, and of the selected one what decided about it. Detections are accepted and
/// rejected here.
class DetectionTable : public QWidget {
    Q_OBJECT
  public:
    DetectionTable(Workbench& workbench, ScanPresenter& presenter, QWidget* parent = nullptr);

    [[nodiscard]] std::vector<ModuleId> selected() const;
    void select(ModuleId module);
    /// What can be done with the selection.
    void refresh();

  signals:
    void selectionChanged();

  private:
    void showEvidence();
    [[nodiscard]] static QString wordsBelowEachOther(const WordReading& reading);

    std::vector<ModuleId> kept_;  ///< selected, while the table is filled anew
    Workbench& workbench_;
    ScanPresenter& presenter_;
    QPushButton* accept_;
    QPushButton* reject_;
    QSortFilterProxyModel* sorted_;
    QTableView* table_;
    std::array<QLabel*, 3> crops_{};
    QLabel* evidence_;
};

}  // namespace skincal
