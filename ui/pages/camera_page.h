#pragma once

#include "core/vision/picture_figures.h"
#include "ui/pages/page.h"
#include "ui/presenters/board_presenter.h"

class QComboBox;
class QPushButton;
class QSlider;
class QUrl;

namespace skincal {

class CalibrationDialog;
class HistogramView;
class PictureView;

class CameraPage : public Page {
    Q_OBJECT
  public:
    CameraPage(Workbench& workbench, ScanPresenter& scan, QWidget* parent = nullptr);
    ~CameraPage() override;

    void setActive(bool active) override;
    /// Offers a video file or stream, and chooses it.
    void openVideo(const QUrl& url);
    /// From a ROS, OpenCV or Kalibr file, once it is read.
    void loadIntrinsics(const QString& file);

  signals:
    void failed(const QString& why);

  private:
    void listDevices();
    void chooseDevice(int offer);
    void askForVideo();
    void listFormats();
    void refresh();
    void showPicture();
    void showPlaceholder();
    void showNotes();
    void calibrateHere();
    void adopt(const CameraModel& camera, CameraOrigin origin, const QString& text);

    Workbench& workbench_;
    ScanPresenter& scan_;
    BoardPresenter board_;
    QComboBox* devices_;
    QComboBox* formats_;
    QSlider* exposure_;
    QLabel* exposureText_;
    PictureView* picture_;
    HistogramView* histogram_;
    QLabel* figures_;
    QLabel* controls_;
    QLabel* intrinsics_;
    QPushButton* load_;
    QPushButton* makers_;
    QPushButton* calibrate_;
    CalibrationDialog* dialog_ = nullptr;  ///< null before the first time
    int loads_ = 0;                        ///< files of intrinsics that were chosen
    bool isActive_ = false;
};

}  // namespace skincal
