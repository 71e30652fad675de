#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/pose_presenter.h"

class QCheckBox;
class QProgressBar;
class QPushButton;
class QTableView;

namespace skincal {

class CurvePlot;
class GravitySphere;

class PosePage : public Page {
    Q_OBJECT
  public:
    explicit PosePage(PosePresenter& presenter, QWidget* parent = nullptr);

    void setActive(bool active) override;
    void selectPose(int pose);

  signals:
    void modulesSelected(const std::vector<skincal::ModuleId>& modules);

  private:
    void showLive();
    void refresh();
    void inspectSelected();
    [[nodiscard]] int selectedRow() const;

    PosePresenter& presenter_;
    GravitySphere* sphere_;
    CurvePlot* forecast_;
    QLabel* instruction_;
    QLabel* movement_;
    QProgressBar* rest_;
    QPushButton* capture_;
    QPushButton* turn_;
    QPushButton* drop_;
    QCheckBox* automatic_;
    QTableView* poses_;
    QLabel* inspected_;
};

}  // namespace skincal
