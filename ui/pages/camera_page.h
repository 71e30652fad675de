#pragma once

#include "core/vision/picture_figures.h"
#include "ui/pages/page.h"
#include "ui/presenters/scan_presenter.h"

class QComboBox;
class QPushButton;
class QSlider;

namespace skincal {

class HistogramView;
class PictureView;

class CameraPage : public Page {
    Q_OBJECT
  public:
    CameraPage(Workbench& workbench, ScanPresenter& scan, QWidget* parent = nullptr);

    void setActive(bool active) override;
    /// A ROS, OpenCV or Kalibr file.
    void loadIntrinsics(const QString& file);

  signals:
    void failed(const QString& why);

  private:
    void listFormats();
    void refresh();
    void showPicture();
    void adopt(const CameraModel& camera, const QString& text);

    Workbench& workbench_;
    ScanPresenter& scan_;
    QComboBox* devices_;
    QComboBox* formats_;
    QSlider* exposure_;
    QLabel* exposureText_;
    PictureView* picture_;
    HistogramView* histogram_;
    QLabel* figures_;
    QLabel* intrinsics_;
    QPushButton* load_;
    QPushButton* makers_;
    bool isActive_ = false;
};

}  // namespace skincal
