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
    [[nodiscard]] QWidget* mainControl() const override;
    void selectPose(int pose);

  signals:
    void modulesSelected(const std::vector<skincal::ModuleId>& modules);

  private:
    void showLive();
    void refresh();
    void inspectSelected();
    [[nodiscard]] int selectedRow() const;
    void showInBody(std::vector<ModuleId> modules);

    PosePresenter& presenter_;
    GravitySphere* sphere_;
    CurvePlot* forecast_;
    QLabel* instruction_;
    QLabel* verdict_;
    QLabel* movement_;
    QProgressBar* rest_;
    QPushButton* capture_;
    QPushButton* turn_;
    QPushButton* drop_;
    QCheckBox* automatic_;
    QTableView* poses_;
    QLabel* inspected_;
    std::optional<int> kept_;       ///< pose selected, while the table is filled anew
    std::vector<ModuleId> inBody_;  ///< that are marked in 3D for the selected pose
    bool isActive_ = false;
};

}  // namespace skincal
