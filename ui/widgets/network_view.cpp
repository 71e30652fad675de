#include "ui/widgets/network_view.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>
#include <algorithm>

#include "ui/widgets/module_keys.h"
#include "ui/widgets/theme.h"

namespace skincal {

NetworkView::NetworkView(QWidget* parent) : QWidget(parent) {
    setAccessibleName(tr("Network of modules"));
    setToolTip(
        tr("How the modules are wired, each patch in a colour of its own; dashed outlines need a look. Click a module, "
           "or go to it with the arrow keys and press Return, to let its LED blink."));
    setFocusPolicy(Qt::StrongFocus);
    setCurrent(std::nullopt);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void NetworkView::setNetwork(FlatNetwork network) {
    network_ = std::move(network);
    const auto& modules = network_.modules;
    // Any change of a link lays the network anew.
    if (std::none_of(modules.begin(), modules.end(), [&](const FlatModule& m) { return m.module == current_; }))
        setCurrent(std::nullopt);
    update();
}

void NetworkView::setFaulty(std::set<ModuleId> modules) {
    faulty_ = std::move(modules);
    update();
}

void NetworkView::setSelected(std::optional<ModuleId> module) {
    selected_ = module;
    update();
}

void NetworkView::setLit(std::optional<ModuleId> module) {
    lit_ = module;
    update();
}

void NetworkView::setPlaceholder(const QString& text) {
    placeholder_ = text;
    update();
}

QTransform NetworkView::transform() const {
    constexpr double kMargin = 18;
    const QRectF& bounds = network_.bounds;
    if (bounds.isEmpty())
        return {};
    constexpr double kLargest = 5;  // px per mm: a lone module should not fill the page
    const double scale =
        std::min({(width() - 2 * kMargin) / bounds.width(), (height() - 2 * kMargin) / bounds.height(), kLargest});
    QTransform result;
    result.translate(0.5 * width(), 0.5 * height());
    result.scale(scale, scale);
    result.translate(-bounds.center().x(), -bounds.center().y());
    return result;
}

void NetworkView::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(theme.line, 1));
    painter.setBrush(theme.panel);
    painter.drawRoundedRect(rect().adjusted(0, 0, -1, -1), 4, 4);
    if (network_.modules.empty()) {
        painter.setPen(theme.muted);
        painter.drawText(rect().adjusted(16, 16, -16, -16), Qt::AlignCenter | Qt::TextWordWrap, placeholder_);
    }
    paintModules(painter, theme);
    paintCables(painter, theme);
    if (!hasFocus())
        return;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(theme.accent, 2));
    painter.drawRoundedRect(rect().adjusted(1, 1, -2, -2), 4, 4);
    for (const FlatModule& module : network_.modules) {
        if (module.module == current_)
            painter.drawRoundedRect(transform().map(module.outline).boundingRect().adjusted(-4, -4, 4, 4), 4, 4);
    }
}

void NetworkView::paintModules(QPainter& painter, const Theme& theme) const {
    const QTransform place = transform();
    const double scale = place.m11();
    QFont numbers = font();
    numbers.setPixelSize(std::clamp(static_cast<int>(8 * scale), 5, 13));
    painter.setFont(numbers);
    for (const FlatModule& module : network_.modules) {
        const QColor tint = patchTint(module.patch);
        const bool isLit = lit_ == module.module;
        QColor fill = tint;
        fill.setAlphaF(isLit ? 1.0F : 0.35F);
        const bool isFaulty = faulty_.contains(module.module);
        const bool isSelected = selected_ == module.module;
        painter.setPen(QPen(isFaulty     ? theme.attention
                            : isSelected ? theme.text
                                         : tint,
                            isFaulty || isSelected ? 3 : 1.4, isFaulty ? Qt::DashLine : Qt::SolidLine));
        painter.setBrush(fill);
        painter.drawPolygon(place.map(module.outline));
        painter.setPen(Qt::NoPen);
        painter.setBrush(tint);
        for (const QPointF& port : module.ports)
            painter.drawEllipse(place.map(port), 2, 2);
        if (numbers.pixelSize() >= 8) {
            painter.setPen(theme.text);
            painter.drawText(QRectF(place.map(module.centre) - QPointF(30, 12), QSizeF(60, 24)), Qt::AlignCenter,
                             QString::number(module.module.value));
        }
    }
}

void NetworkView::paintCables(QPainter& painter, const Theme& theme) const {
    const QTransform place = transform();
    painter.setBrush(Qt::NoBrush);
    for (const FlatLink& link : network_.links) {
        if (link.kind != LinkKind::Cable)
            continue;
        const QPointF from = place.map(link.from);
        const QPointF to = place.map(link.to);
        const QPointF way = to - from;
        const QPointF aside(-0.18 * way.y(), 0.18 * way.x());
        QPainterPath path(from);
        path.quadTo(0.5 * (from + to) + aside, to);
        painter.setPen(QPen(theme.text, 1.6, Qt::DashLine));
        painter.drawPath(path);
    }
}

const FlatModule* NetworkView::moduleAt(const QPointF& position) const {
    const QPointF mm = transform().inverted().map(position);
    const auto found = std::find_if(network_.modules.begin(), network_.modules.end(), [&](const FlatModule& module) {
        return module.outline.containsPoint(mm, Qt::OddEvenFill);
    });
    return found == network_.modules.end() ? nullptr : &*found;
}

void NetworkView::mouseReleaseEvent(QMouseEvent* event) {
    if (const FlatModule* module = moduleAt(event->position())) {
        setCurrent(module->module);
        emit moduleClicked(module->module);
    }
}

void NetworkView::setCurrent(std::optional<ModuleId> module) {
    current_ = module;
    setAccessibleDescription(!module                     ? tr("Arrow keys go from module to module")
                             : faulty_.contains(*module) ? tr("Module %1, needs attention").arg(module->value)
                                                         : tr("Module %1").arg(module->value));
    update();
}

void NetworkView::keyPressEvent(QKeyEvent* event) {
    std::vector<ModulePlace> places;
    for (const FlatModule& module : network_.modules)
        places.push_back({module.module, toWidget(module.centre)});
    const int key = event->key();
    if (const auto next = moduleByKey(key, std::move(places), current_ ? current_ : selected_))
        setCurrent(next);
    else if (current_ && (key == Qt::Key_Return || key == Qt::Key_Enter || key == Qt::Key_Space))
        emit moduleClicked(*current_);
    else
        QWidget::keyPressEvent(event);
}

bool NetworkView::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip)
        return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    if (const FlatModule* module = moduleAt(help->pos()))
        QToolTip::showText(help->globalPos(), tr("Module %1: click to let its LED blink").arg(module->module.value),
                           this);
    else
        QToolTip::showText(help->globalPos(), toolTip(), this);
    return true;
}

}  // namespace skincal
