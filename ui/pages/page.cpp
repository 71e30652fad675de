#include "ui/pages/page.h"

namespace skincal {

Page::Page(const QString& title, const QString& purpose, QWidget* parent)
    : QWidget(parent), layout_(new QVBoxLayout(this)) {
    layout_->setContentsMargins(20, 16, 20, 12);
    layout_->setSpacing(10);
    auto* heading = new QLabel(title);
    heading->setObjectName(QStringLiteral("pageTitle"));
    layout_->addWidget(heading);
    auto* line = new QLabel(purpose);
    line->setObjectName(QStringLiteral("pagePurpose"));
    line->setWordWrap(true);
    layout_->addWidget(line);
}

int Page::heightForWidth(int width) const {
    return layout_->minimumHeightForWidth(width);
}

void keepTwoLines(QLabel& label) {
    label.setProperty("twoLines", true);
    label.setAlignment(Qt::AlignLeft | Qt::AlignVCenter);
}

QLabel* mutedLabel(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("muted", true);
    label->setWordWrap(true);
    return label;
}

}  // namespace skincal
