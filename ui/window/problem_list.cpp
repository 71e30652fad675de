#include "ui/window/problem_list.h"

#include <QPainter>
#include <QStyledItemDelegate>

#include "ui/window/step_delegate.h"

namespace skincal {
namespace {

constexpr int kSign = 34;  // px, the width of its column
constexpr int kStep = 130;
constexpr int kMargin = 5;  // px, above and below a sentence

QRect textRect(const QRect& row) {
    return row.adjusted(kSign + kStep, kMargin, -8, -kMargin);
}

/// Told apart by shape as well as by colour: a square, a triangle, a dot.
void paintSign(QPainter& painter, const QPointF& at, Problem::Severity severity, const Theme& theme) {
    painter.setPen(Qt::NoPen);
    switch (severity) {
        case Problem::Severity::Error:
            painter.setBrush(theme.bad);
            painter.drawRect(QRectF(at - QPointF(5, 5), QSizeF(10, 10)));
            return;
        case Problem::Severity::Warning:
            painter.setBrush(theme.attention);
            painter.drawPolygon(QPolygonF{at + QPointF(0, -6), at + QPointF(6, 5), at + QPointF(-6, 5)});
            return;
        default:
            painter.setBrush(theme.accent);
            painter.drawEllipse(at, 4.5, 4.5);
    }
}

class ProblemDelegate : public QStyledItemDelegate {
  public:
    explicit ProblemDelegate(const QListView& list) : list_(list) {}

    void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
        const Theme theme = Theme::current();
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        paintSelected(*painter, option, theme);
        const QRect text = textRect(option.rect);
        const double middle = text.top() + 0.5 * option.fontMetrics.height();
        paintSign(*painter, QPointF(option.rect.left() + 18, middle),
                  static_cast<Problem::Severity>(index.data(ProblemModel::SeverityRole).toInt()), theme);
        painter->setPen(theme.muted);
        painter->drawText(QRect(option.rect.left() + kSign, text.top(), kStep, text.height()),
                          Qt::AlignLeft | Qt::AlignTop, index.data(ProblemModel::StepRole).toString());
        painter->setPen(theme.text);
        painter->drawText(text, Qt::AlignLeft | Qt::AlignTop | Qt::TextWordWrap, index.data().toString());
        painter->restore();
    }

    [[nodiscard]] QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
        const QRect row(0, 0, list_.viewport()->width(), 10000);
        const QRect needed = option.fontMetrics.boundingRect(
            textRect(row), Qt::AlignLeft | Qt::AlignTop | Qt::TextWordWrap, index.data().toString());
        return {row.width(), needed.height() + 2 * kMargin};
    }

  private:
    const QListView& list_;
};

}  // namespace

ProblemList::ProblemList(ProblemModel& model, QWidget* parent) : QListView(parent) {
    setObjectName(QStringLiteral("problems"));
    setAccessibleName(tr("Problems"));
    setModel(&model);
    auto* delegate = new ProblemDelegate(*this);
    delegate->setParent(this);
    setItemDelegate(delegate);
    setFrameShape(QFrame::NoFrame);
    setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    setVerticalScrollMode(ScrollPerPixel);
    setResizeMode(Adjust);
    setToolTip(tr("What is wrong or missing; activate one to go where it is mended"));
    for (const auto signal : {&QListView::activated, &QListView::clicked})
        connect(this, signal, this, [this](const QModelIndex& index) { emit chosen(index.row()); });
}

void ProblemList::paintEvent(QPaintEvent* event) {
    QListView::paintEvent(event);
    if (model()->rowCount() > 0)
        return;
    QPainter painter(viewport());
    painter.setPen(Theme::current().muted);
    painter.drawText(viewport()->rect(), Qt::AlignCenter, tr("No problems."));
}

}  // namespace skincal
