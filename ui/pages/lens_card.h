#pragma once

#include <QFrame>

#include "core/formats/camera_export.h"
#include "ui/presenters/board_presenter.h"

class QComboBox;
class QLabel;
class QPushButton;

namespace skincal {

/// The lens that follows from the boards, how good it is, and what to do with it.
class LensCard : public QFrame {
    Q_OBJECT
  public:
    explicit LensCard(BoardPresenter& presenter, QWidget* parent = nullptr);

    /// Nothing where there is no lens yet.
    void saveAs(const QString& file, CameraFileKind kind);

  signals:
    /// Its intrinsics are the session's now.
    void used();
    void told(const QString& note, bool isBad);

  private:
    void chooseSave();
    void refresh();

    BoardPresenter& presenter_;
    QComboBox* lens_;
    QLabel* verdict_;
    QLabel* figures_;
    QPushButton* use_;
    QPushButton* save_;
};

}  // namespace skincal
