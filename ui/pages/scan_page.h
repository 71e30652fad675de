#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/scan_presenter.h"

class QComboBox;
class QProgressBar;
class QPushButton;
class QSortFilterProxyModel;
class QTableView;

namespace skincal {

class PictureView;

class ScanPage : public Page {
    Q_OBJECT
  public:
    ScanPage(Workbench& workbench, ScanPresenter& presenter, QWidget* parent = nullptr);

    void setActive(bool active) override;

  signals:
    void moduleSelected(skincal::ModuleId module);

  private:
    void refresh();
    void listViews();
    void showPicture();
    void showMarks();
    void showEvidence();
    void select(ModuleId module);
    [[nodiscard]] std::vector<ModuleId> selected() const;

    Workbench& workbench_;
    ScanPresenter& presenter_;
    PictureView* picture_;
    QComboBox* views_;
    QPushButton* start_;
    QPushButton* pause_;
    QPushButton* again_;
    QPushButton* dropView_;
    QPushButton* accept_;
    QPushButton* reject_;
    QProgressBar* progress_;
    QLabel* status_;
    QSortFilterProxyModel* sorted_;
    QTableView* table_;
    QLabel* summary_;
    std::array<QLabel*, 3> crops_{};
    QLabel* evidence_;
    bool isActive_ = false;
};

}  // namespace skincal
