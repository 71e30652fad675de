#include "ui/widgets/overlap_graph.h"

#include <QPainter>
#include <map>

#include "ui/widgets/theme.h"

namespace skincal {

OverlapGraph::OverlapGraph(QWidget* parent) : QWidget(parent) {
    setAccessibleName(tr("Which views show which patches"));
    setToolTip(tr("A patch can be placed where a view shows it together with one that is placed. Filled is placed."));
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void OverlapGraph::setGraph(std::vector<ViewState> views, std::vector<PatchState> patches) {
    views_ = std::move(views);
    patches_ = std::move(patches);
    update();
}

void OverlapGraph::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(theme.line, 1));
    painter.setBrush(theme.panel);
    painter.drawRoundedRect(rect().adjusted(0, 0, -1, -1), 4, 4);
    if (views_.empty() && patches_.empty()) {
        painter.setPen(theme.muted);
        painter.drawText(rect(), Qt::AlignCenter, tr("Views and patches appear here."));
        return;
    }
    const auto place = [&](std::size_t i, std::size_t count, double y) {
        return QPointF(width() * (static_cast<double>(i) + 1) / (static_cast<double>(count) + 1), y);
    };
    const double room = width() / (static_cast<double>(std::max(views_.size(), patches_.size())) + 1);
    const double radius = std::clamp(0.3 * room, 6.0, 17.0);
    // Names stand above the views and below the patches.
    const double above = std::max(0.27 * height(), radius + 24);
    const double below = std::min(0.72 * height(), height() - radius - 40);
    std::map<std::string, QPointF> views;
    for (std::size_t i = 0; i < views_.size(); ++i)
        views[views_[i].name] = place(i, views_.size(), above);
    for (std::size_t k = 0; k < patches_.size(); ++k) {
        QColor tint = patchTint(patches_[k].patch.value);
        painter.setPen(QPen(tint, 2));
        for (const std::string& view : patches_[k].views)
            painter.drawLine(views[view], place(k, patches_.size(), below));
    }
    for (const ViewState& view : views_) {
        const QPointF at = views[view.name];
        painter.setPen(
            QPen(view.isDropped ? theme.line : theme.text, 1.6, view.isDropped ? Qt::DashLine : Qt::SolidLine));
        painter.setBrush(view.isPlaced ? theme.text : theme.panel);
        painter.drawRoundedRect(QRectF(at - QPointF(radius, 0.7 * radius), QSizeF(2 * radius, 1.4 * radius)), 3, 3);
        painter.setPen(theme.muted);
        if (room > 46)
            painter.drawText(QRectF(at - QPointF(50, radius + 22), QSizeF(100, 18)), Qt::AlignCenter,
                             QString::fromStdString(view.name));
    }
    for (std::size_t k = 0; k < patches_.size(); ++k) {
        const QPointF at = place(k, patches_.size(), below);
        const QColor tint = patchTint(patches_[k].patch.value);
        painter.setPen(QPen(tint, 2.5, patches_[k].isPlaced ? Qt::SolidLine : Qt::DashLine));
        painter.setBrush(patches_[k].isPlaced ? tint : theme.panel);
        painter.drawEllipse(at, radius, radius);
        painter.setPen(theme.muted);
        if (room > 60)
            painter.drawText(QRectF(at + QPointF(-60, radius + 3), QSizeF(120, 34)), Qt::AlignHCenter | Qt::AlignTop,
                             tr("patch %1\n%n modules", nullptr, static_cast<int>(patches_[k].modules))
                                 .arg(patches_[k].patch.value));
    }
}

}  // namespace skincal
