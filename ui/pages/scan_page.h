#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/scan_presenter.h"

class QComboBox;
class QProgressBar;
class QPushButton;

namespace skincal {

class DetectionTable;
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

    Workbench& workbench_;
    ScanPresenter& presenter_;
    PictureView* picture_;
    QComboBox* views_;
    QPushButton* start_;
    QPushButton* pause_;
    QComboBox* code_;
    QPushButton* again_;
    QPushButton* dropView_;
    QProgressBar* progress_;
    QLabel* status_;
    DetectionTable* table_;
    QLabel* summary_;
    bool isActive_ = false;
    bool wasBusy_ = false;
};

}  // namespace skincal
