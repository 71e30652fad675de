#pragma once

#include <QWidget>

#include "core/camera_calibration/board_plan.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QSpinBox;

namespace skincal {

/// What the printed board looks like.
class BoardForm : public QWidget {
    Q_OBJECT
  public:
    explicit BoardForm(const BoardPlan& plan, QWidget* parent = nullptr);

    /// May be none that can be printed: see fault().
    [[nodiscard]] BoardPlan plan() const;
    /// What is wrong with it, in a sentence; empty where nothing is. Shown below the fields, too.
    [[nodiscard]] QString fault() const;

  signals:
    void changed();

  private:
    void refresh();

    QComboBox* kind_;
    QSpinBox* columns_;
    QSpinBox* rows_;
    QDoubleSpinBox* square_;
    QDoubleSpinBox* marker_;
    QComboBox* dictionary_;
    QLabel* fault_;
};

}  // namespace skincal
