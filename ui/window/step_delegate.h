#pragma once

#include <QStyledItemDelegate>

#include "ui/widgets/theme.h"

namespace skincal {

/// A step of the procedure: its number or state in a circle, its name, and below what it asks for.
class StepDelegate : public QStyledItemDelegate {
    Q_OBJECT
  public:
    using QStyledItemDelegate::QStyledItemDelegate;

    void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override;
    [[nodiscard]] QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override;
};

/// The ground of a row that is selected.
void paintSelected(QPainter& painter, const QStyleOptionViewItem& option, const Theme& theme);

}  // namespace skincal
