#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/views_presenter.h"

class QPushButton;

namespace skincal {

class OverlapGraph;
class PictureView;
class ScanPresenter;

class ViewsPage : public Page {
    Q_OBJECT
  public:
    ViewsPage(ViewsPresenter& presenter, ScanPresenter& scan, QWidget* parent = nullptr);

    void setActive(bool active) override;

  signals:
    /// The operator wants to scan from here.
    void scanAsked();

  private:
    void refresh();

    ViewsPresenter& presenter_;
    ScanPresenter& scan_;
    QLabel* instruction_;
    QLabel* reason_;
    QPushButton* move_;
    QPushButton* scanHere_;
    OverlapGraph* graph_;
    PictureView* picture_;
    bool isActive_ = false;
};

}  // namespace skincal
