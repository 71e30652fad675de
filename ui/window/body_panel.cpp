#include "ui/window/body_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/scene3d/body_view_widget.h"

namespace skincal {

BodyPanel::BodyPanel(QWidget* parent)
    : QWidget(parent), view_(new BodyViewWidget), colours_(new QComboBox), stale_(new QLabel(tr("Stale"))) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    auto* bar = new QHBoxLayout;
    bar->setContentsMargins(10, 6, 10, 6);
    colours_->setObjectName(QStringLiteral("colours"));
    colours_->setAccessibleName(tr("Colours of the body"));
    colours_->setToolTip(tr("What the colours of the modules tell"));
    const std::vector<std::pair<QString, ColourMode>> modes{{tr("Patch"), ColourMode::Patch},
                                                            {tr("Uncertainty"), ColourMode::Uncertainty},
                                                            {tr("Residual"), ColourMode::Residual},
                                                            {tr("Number of views"), ColourMode::ViewCount},
                                                            {tr("Last view"), ColourMode::LastView}};
    for (const auto& [name, mode] : modes)
        colours_->addItem(name, static_cast<int>(mode));
    auto* ellipsoids = new QCheckBox(tr("Ellipsoids"));
    ellipsoids->setToolTip(tr("Where each module is with three standard deviations, enlarged as the legend says"));
    auto* measure = new QPushButton(tr("Measure"));
    measure->setObjectName(QStringLiteral("measure"));
    measure->setCheckable(true);
    measure->setToolTip(
        tr("Click two modules to see how far their LEDs are apart; by keys: Page Down to each in the 3D view, and "
           "Return"));
    auto* fit = new QPushButton(tr("Fit"));
    fit->setToolTip(tr("Show the whole body, and the mesh about it (F)"));
    bar->addWidget(colours_);
    bar->addWidget(ellipsoids);
    bar->addStretch();
    stale_->setToolTip(tr("The body is of before the last change; the newest data are being solved, or give no body"));
    stale_->setProperty("attention", true);
    stale_->hide();
    bar->addWidget(stale_);
    bar->addSpacing(8);
    bar->addWidget(measure);
    bar->addWidget(fit);
    column->addLayout(bar);
    column->addWidget(view_, 1);
    connect(colours_, &QComboBox::currentIndexChanged, this,
            [this] { view_->setColourMode(static_cast<ColourMode>(colours_->currentData().toInt())); });
    connect(ellipsoids, &QCheckBox::toggled, view_, &BodyViewWidget::setEllipsoidsShown);
    connect(measure, &QPushButton::toggled, view_, &BodyViewWidget::setMeasuring);
    connect(fit, &QPushButton::clicked, view_, &BodyViewWidget::fitView);
}

void BodyPanel::setStale(bool stale) {
    stale_->setVisible(stale);
}

}  // namespace skincal
