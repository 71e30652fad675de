#include "ui/window/step_delegate.h"

#include <QPainter>

#include "ui/presenters/step_model.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

QFont smaller(QFont font) {
    if (font.pixelSize() > 0)
        font.setPixelSize(font.pixelSize() - 1);
    else
        font.setPointSizeF(0.9 * font.pointSizeF());
    return font;
}

/// The sign of a state: a tick, an exclamation mark, or the step's number.
void paintSign(QPainter& painter, const QPointF& centre, StepStatus status, int number, const Theme& theme) {
    constexpr double kRadius = 11;
    const bool isFilled = status == StepStatus::Done || status == StepStatus::NeedsAttention;
    const QColor colour = status == StepStatus::Done             ? theme.good
                          : status == StepStatus::NeedsAttention ? theme.attention
                          : status == StepStatus::Blocked        ? theme.line
                                                                 : theme.accent;
    painter.setPen(QPen(colour, 1.8));
    painter.setBrush(isFilled ? QBrush(colour) : QBrush(Qt::NoBrush));
    painter.drawEllipse(centre, kRadius, kRadius);
    const QColor ink = isFilled ? (theme.isDark ? QColor("#10151d") : QColor("#ffffff"))
                                : (status == StepStatus::Blocked ? theme.muted : theme.text);
    painter.setPen(QPen(ink, 2));
    if (status == StepStatus::Done) {
        painter.drawPolyline(QPolygonF{centre + QPointF(-5, 0), centre + QPointF(-1.5, 4), centre + QPointF(5, -4)});
        return;
    }
    const QString text = status == StepStatus::NeedsAttention ? QStringLiteral("!") : QString::number(number);
    painter.drawText(QRectF(centre - QPointF(kRadius, kRadius), QSizeF(2 * kRadius, 2 * kRadius)), Qt::AlignCenter,
                     text);
    if (status == StepStatus::InProgress) {
        painter.setPen(QPen(theme.accent, 3));
        painter.drawArc(QRectF(centre - QPointF(kRadius, kRadius), QSizeF(2 * kRadius, 2 * kRadius)), 90 * 16,
                        -180 * 16);
    }
}

}  // namespace

void paintSelected(QPainter& painter, const QStyleOptionViewItem& option, const Theme& theme) {
    if ((option.state & QStyle::State_Selected) != 0) {
        QColor ground = theme.accent;
        ground.setAlphaF(0.18F);
        painter.fillRect(option.rect, ground);
        painter.fillRect(QRect(option.rect.topLeft(), QSize(3, option.rect.height())), theme.accent);
    }
}

void StepDelegate::paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const {
    const Theme theme = Theme::current();
    const auto status = static_cast<StepStatus>(index.data(StepModel::StatusRole).toInt());
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    paintSelected(*painter, option, theme);
    const QRectF rect = option.rect;
    paintSign(*painter, QPointF(rect.left() + 26, rect.center().y()), status, index.row() + 1, theme);
    const QString reason = status == StepStatus::Done ? QString() : index.data(StepModel::ReasonRole).toString();
    const QRectF text = rect.adjusted(48, 0, -8, 0);
    QFont font = option.font;
    font.setWeight(QFont::DemiBold);
    painter->setFont(font);
    painter->setPen(status == StepStatus::Blocked ? theme.muted : theme.text);
    const double middle = rect.center().y();
    const double high = QFontMetricsF(font).height();
    painter->drawText(QRectF(text.left(), reason.isEmpty() ? middle - 0.5 * high : middle - high, text.width(), high),
                      Qt::AlignLeft | Qt::AlignVCenter, index.data().toString());
    if (!reason.isEmpty()) {
        const QFont small = smaller(option.font);
        painter->setFont(small);
        painter->setPen(status == StepStatus::NeedsAttention ? theme.attention : theme.muted);
        painter->drawText(QRectF(text.left(), middle, text.width(), high), Qt::AlignLeft | Qt::AlignVCenter,
                          QFontMetrics(small).elidedText(reason, Qt::ElideRight, static_cast<int>(text.width())));
    }
    painter->restore();
}

QSize StepDelegate::sizeHint(const QStyleOptionViewItem& option, const QModelIndex&) const {
    return {220, 2 * QFontMetrics(option.font).height() + 22};
}

}  // namespace skincal
