#pragma once

#include <QWidget>

#include "ui/presenters/views_presenter.h"

namespace skincal {

/// Views above, patches below, a line where a view shows a patch. What is placed is filled.
class OverlapGraph : public QWidget {
    Q_OBJECT
  public:
    explicit OverlapGraph(QWidget* parent = nullptr);

    void setGraph(std::vector<ViewState> views, std::vector<PatchState> patches);

    [[nodiscard]] QSize sizeHint() const override { return {520, 220}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {260, 160}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    std::vector<ViewState> views_;
    std::vector<PatchState> patches_;
};

}  // namespace skincal
