#include "ui/presenters/board_model.h"

#include <cmath>

#include "ui/presenters/board_sign.h"

namespace skincal {

BoardModel::BoardModel(const BoardPresenter& presenter, QObject* parent)
    : QAbstractTableModel(parent), presenter_(presenter), rows_(presenter.boards().views().size()) {
    connect(&presenter, &BoardPresenter::boardsChanged, this, &BoardModel::follow);
    connect(&presenter, &BoardPresenter::calibrationChanged, this, [this] {
        if (rows_ > 0)
            emit dataChanged(index(0, Residual), index(static_cast<int>(rows_) - 1, Residual));
    });
}

void BoardModel::follow() {
    const std::size_t now = presenter_.boards().views().size();
    if (now == rows_ + 1) {
        // What is selected stays so.
        beginInsertRows({}, static_cast<int>(rows_), static_cast<int>(rows_));
        rows_ = now;
        endInsertRows();
        return;
    }
    beginResetModel();
    rows_ = now;
    endResetModel();
}

int BoardModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : static_cast<int>(rows_);
}

int BoardModel::columnCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : static_cast<int>(kColumns);
}

const CalibratedBoard* BoardModel::calibratedAt(std::size_t board) const {
    const auto& calibration = presenter_.calibration();
    return calibration && board < calibration->boards.size() ? &calibration->boards[board] : nullptr;
}

QString BoardModel::textAt(std::size_t board, int column) const {
    const BoardView& view = presenter_.boards().views().at(board);
    switch (column) {
        case Board:
            return QString::number(board + 1);
        case Corners:
            return QString::number(view.corners.size());
        case Blur:
            return QString::number(view.blur_px, 'f', 2);
        default: {
            const CalibratedBoard* calibrated = calibratedAt(board);
            if (calibrated == nullptr)
                return tr("–");
            const QString rms =
                std::isfinite(calibrated->rms_px) ? QString::number(calibrated->rms_px, 'f', 2) : tr("∞");
            return calibrated->used ? rms : tr("%1, left out").arg(rms);
        }
    }
}

QVariant BoardModel::data(const QModelIndex& index, int role) const {
    if (!checkIndex(index, CheckIndexOption::IndexIsValid))
        return {};
    const auto board = static_cast<std::size_t>(index.row());
    switch (role) {
        case Qt::DisplayRole:
            return textAt(board, index.column());
        case Qt::DecorationRole:
            return index.column() == Board ? QVariant(pictureOf(boardSign(board))) : QVariant();
        case Qt::TextAlignmentRole:
            return static_cast<int>(Qt::AlignVCenter | (index.column() == Board ? Qt::AlignLeft : Qt::AlignRight));
        case Qt::ToolTipRole: {
            const CalibratedBoard* calibrated = calibratedAt(board);
            return calibrated != nullptr && !calibrated->used
                       ? tr("It disagrees with the others and has no part in the result.")
                       : QVariant();
        }
        default:
            return {};
    }
}

QVariant BoardModel::headerData(int section, Qt::Orientation orientation, int role) const {
    if (orientation != Qt::Horizontal)
        return {};
    if (role == Qt::TextAlignmentRole)
        return static_cast<int>(Qt::AlignVCenter | (section == Board ? Qt::AlignLeft : Qt::AlignRight));
    if (role == Qt::DisplayRole) {
        switch (section) {
            case Board:
                return tr("Board");
            case Corners:
                return tr("Corners");
            case Blur:
                return tr("Blur, px");
            default:
                return tr("Residual, px");
        }
    }
    if (role == Qt::ToolTipRole) {
        switch (section) {
            case Corners:
                return tr("Inner corners that were found");
            case Blur:
                return tr("How wide edges are smeared, one standard deviation");
            case Residual:
                return tr("How far corners lie from where the calibrated camera has them, root mean square");
            default:
                return {};
        }
    }
    return {};
}

}  // namespace skincal
