#pragma once

#include <QListView>

#include "ui/presenters/problem_model.h"

namespace skincal {

/// What is wrong or missing, each with a sign for how grave it is and the step it belongs to; what to do stands at a
/// sentence's end, so that no sentence is cut. It keeps its place where there is nothing to tell: what stands above it
/// must not move when something turns up.
class ProblemList : public QListView {
    Q_OBJECT
  public:
    explicit ProblemList(ProblemModel& model, QWidget* parent = nullptr);

  signals:
    /// By mouse or key.
    void chosen(int row);

  protected:
    void paintEvent(QPaintEvent* event) override;
};

}  // namespace skincal
