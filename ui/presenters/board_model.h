#pragma once

#include <QAbstractTableModel>

#include "ui/presenters/board_presenter.h"

namespace skincal {

/// The boards that were taken, a row each.
class BoardModel : public QAbstractTableModel {
    Q_OBJECT
  public:
    enum Column { Board, Corners, Blur, Residual, kColumns };

    explicit BoardModel(const BoardPresenter& presenter, QObject* parent = nullptr);

    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override;
    [[nodiscard]] QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

  private:
    void follow();
    [[nodiscard]] const CalibratedBoard* calibratedAt(std::size_t board) const;
    [[nodiscard]] QString textAt(std::size_t board, int column) const;

    const BoardPresenter& presenter_;
    std::size_t rows_ = 0;
};

}  // namespace skincal
