#pragma once

#include <QDialog>

#include "core/formats/camera_export.h"
#include "ui/presenters/board_model.h"

class QLabel;
class QProgressBar;
class QPushButton;
class QTableView;

namespace skincal {

class BoardForm;
class BoardPicture;
class LensCard;
class ResidualPlot;

/// Calibrates the camera from a board: what it looks like, what the camera sees of it, boards that were taken, and the
/// lens that follows. Closing it stops looking; boards are still there when it is opened again.
class CalibrationDialog : public QDialog {
    Q_OBJECT
  public:
    CalibrationDialog(BoardPresenter& presenter, const ScanPresenter& scan, QWidget* parent);

    /// A PDF to print at its true size.
    void printBoard(const QString& file);
    void saveAs(const QString& file, CameraFileKind kind);

    void done(int result) override;

  protected:
    void changeEvent(QEvent* event) override;

  private:
    [[nodiscard]] QWidget* buildSight();
    [[nodiscard]] QWidget* buildBoards();
    [[nodiscard]] QWidget* buildSide();
    [[nodiscard]] QWidget* buildBoardCard();
    void connectAll();
    void startOrStop();
    void choosePrint();
    void showLive();
    void showSight();
    void showBoards();
    void showResiduals();
    void showState();
    void showChosen();
    void tell(const QString& note, bool isBad);
    void say(const QString& mark, const QColor& colour, const QString& sentence);
    [[nodiscard]] std::optional<std::size_t> chosenBoard() const;

    BoardPresenter& presenter_;
    const ScanPresenter& scan_;
    BoardModel* model_;
    BoardForm* form_ = nullptr;
    LensCard* lensCard_ = nullptr;
    BoardPicture* picture_ = nullptr;
    QLabel* sentence_ = nullptr;
    QLabel* wish_ = nullptr;
    QLabel* count_ = nullptr;
    QProgressBar* progress_ = nullptr;
    QTableView* boards_ = nullptr;
    ResidualPlot* plot_ = nullptr;
    QPushButton* take_ = nullptr;
    QPushButton* print_ = nullptr;
    QPushButton* startOver_ = nullptr;
    QPushButton* remove_ = nullptr;
    QPushButton* takeBack_ = nullptr;
    QString note_;  ///< what there is to say while nobody looks
    bool isNoteBad_ = false;
};

}  // namespace skincal
