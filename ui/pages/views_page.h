#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/view_preview.h"

class QPushButton;

namespace skincal {

class OverlapGraph;
class PictureView;

class ViewsPage : public Page {
    Q_OBJECT
  public:
    ViewsPage(ViewsPresenter& presenter, ScanPresenter& scan, ViewPreview& preview, QWidget* parent = nullptr);

    void setActive(bool active) override;

  protected:
    void changeEvent(QEvent* event) override;

  signals:
    /// The operator wants to scan from here.
    void scanAsked();

  private:
    void refresh();
    void showHint();

    ViewsPresenter& presenter_;
    ScanPresenter& scan_;
    ViewPreview& preview_;
    QLabel* instruction_;
    QLabel* reason_;
    QLabel* hint_;
    QPushButton* move_;
    QPushButton* scanHere_;
    OverlapGraph* graph_;
    PictureView* picture_;
    bool isActive_ = false;
    bool hasMoved_ = false;  ///< the camera, by its button, since the last scan
};

}  // namespace skincal
