#include "ui/pages/demo_page.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QEvent>
#include <QPushButton>
#include <QShortcut>
#include <QSlider>
#include <QStyle>

#include "ui/widgets/contact_table.h"
#include "ui/widgets/theme.h"
#include "ui/widgets/trace_plot.h"

namespace skincal {
namespace {

constexpr int kTick_ms = 10;  // of the slider
constexpr double kSpan_s = std::chrono::duration<double>(DemoPresenter::Time(TactileHistory::kSpan)).count();

}  // namespace

QColor traceColour(std::size_t place, bool isDark) {
    // The bright ones first: curves are thin.
    constexpr std::array<unsigned, 8> kOrder{4, 1, 2, 3, 0, 5, 6, 7};
    const QColor colour = patchTint(kOrder.at(place % kOrder.size()));
    return isDark ? colour : colour.darker(125);
}

DemoPage::DemoPage(DemoPresenter& presenter, QWidget* parent)
    : Page(tr("Live demo"),
           tr("What the skin feels now, and where: in the body's frame every touch has a place and a direction."),
           parent),
      presenter_(presenter),
      quantity_(new QComboBox),
      raised_(new QCheckBox(tr("Raise modules"))),
      touch_(new QPushButton(tr("Touch"))),
      force_(new QDoubleSpinBox),
      orbit_(new QPushButton(tr("Orbit"))),
      instruction_(new QLabel),
      contacts_(new ContactTable),
      curves_(mutedLabel()),
      plot_(new TracePlot),
      follow_(new QCheckBox(tr("Follow touches"))),
      time_(new QSlider(Qt::Horizontal)),
      ago_(new QLabel),
      live_(new QPushButton) {
    instruction_->setObjectName(QStringLiteral("instruction"));
    instruction_->setWordWrap(true);
    body().addWidget(instruction_);
    body().addLayout(buildControls());
    contacts_->setObjectName(QStringLiteral("contacts"));
    contacts_->setAccessibleName(tr("Strongest contacts"));
    contacts_->setToolTip(tr("What presses hardest, and where in the body's frame. Click a line to trace its module."));
    body().addWidget(contacts_);
    body().addLayout(buildCurves(), 1);
    body().addLayout(buildTime());

    connect(plot_, &TracePlot::momentAsked, this, [this](double ago) {
        presenter_.showAgo(std::chrono::duration_cast<DemoPresenter::Time>(std::chrono::duration<double>(ago)));
    });
    connect(contacts_, &ContactTable::moduleClicked, &presenter, &DemoPresenter::toggleTraced);
    connect(&presenter, &DemoPresenter::updated, this, &DemoPage::showLive);
    connect(&presenter, &DemoPresenter::stateChanged, this, &DemoPage::refresh);
    refresh();
}

QLayout* DemoPage::buildControls() {
    auto* row = new QHBoxLayout;
    quantity_->setObjectName(QStringLiteral("quantity"));
    quantity_->setAccessibleName(tr("Quantity"));
    quantity_->setToolTip(tr("What colours, heights and curves show"));
    for (const Quantity quantity : kQuantities)
        quantity_->addItem(nameOf(quantity), static_cast<int>(quantity));
    quantity_->setCurrentIndex(static_cast<int>(presenter_.quantity()));
    raised_->setChecked(true);
    raised_->setToolTip(tr("Modules stand out of the body by what they feel"));
    const bool canTouch = presenter_.canTouch();
    touch_->setObjectName(QStringLiteral("touch"));
    touch_->setCheckable(true);
    touch_->setChecked(canTouch);
    touch_->setVisible(canTouch);
    touch_->setToolTip(
        tr("The mouse touches the simulated skin instead of turning the body; beside the body it still turns it"));
    force_->setObjectName(QStringLiteral("force"));
    force_->setAccessibleName(tr("Force of the touch"));
    force_->setToolTip(tr("How hard the mouse presses"));
    force_->setSuffix(tr(" N"));
    force_->setRange(0.5, 20);
    force_->setSingleStep(0.5);
    force_->setDecimals(1);
    force_->setValue(presenter_.force());
    force_->setVisible(canTouch);
    orbit_->setObjectName(QStringLiteral("orbit"));
    orbit_->setCheckable(true);
    orbit_->setToolTip(tr("The camera goes slowly round the body, for an audience"));
    auto* fullScreen = new QPushButton(tr("Full screen"));
    fullScreen->setObjectName(QStringLiteral("fullScreen"));
    fullScreen->setToolTip(tr("Nothing but the body (F11); Escape brings the window back"));
    row->addWidget(quantity_);
    row->addWidget(raised_);
    row->addStretch();
    row->addWidget(touch_);
    row->addWidget(force_);
    row->addWidget(orbit_);
    row->addWidget(fullScreen);
    connect(quantity_, &QComboBox::currentIndexChanged, this,
            [this] { presenter_.setQuantity(static_cast<Quantity>(quantity_->currentData().toInt())); });
    connect(force_, &QDoubleSpinBox::valueChanged, &presenter_, &DemoPresenter::setForce);
    connect(raised_, &QCheckBox::toggled, this, &DemoPage::stageChanged);
    connect(touch_, &QPushButton::toggled, this, &DemoPage::stageChanged);
    connect(orbit_, &QPushButton::toggled, this, &DemoPage::stageChanged);
    connect(fullScreen, &QPushButton::clicked, this, &DemoPage::fullScreenAsked);
    auto* key = new QShortcut(QKeySequence(Qt::Key_F11), this);
    connect(key, &QShortcut::activated, this, &DemoPage::fullScreenAsked);
    return row;
}

QLayout* DemoPage::buildCurves() {
    auto* column = new QVBoxLayout;
    column->setSpacing(4);
    auto* heading = new QHBoxLayout;
    follow_->setObjectName(QStringLiteral("follow"));
    follow_->setToolTip(tr("Curves are those of the modules touched last; otherwise of those that you click on"));
    heading->addWidget(curves_, 1);
    heading->addWidget(follow_);
    column->addLayout(heading);
    plot_->setAccessibleName(tr("Values over time"));
    plot_->setToolTip(tr("The last 30 s of up to four modules; click to look at a moment"));
    plot_->setPlaceholder(tr("Touched modules appear here"));
    plot_->setSpan(kSpan_s);
    column->addWidget(plot_, 1);
    return column;
}

QLayout* DemoPage::buildTime() {
    auto* row = new QHBoxLayout;
    time_->setObjectName(QStringLiteral("time"));
    time_->setAccessibleName(tr("Moment that is shown"));
    time_->setToolTip(tr("Goes back by up to 30 s; meanwhile nothing is recorded"));
    time_->setRange(-static_cast<int>(1e3 * kSpan_s) / kTick_ms, 0);
    time_->setSingleStep(10);
    time_->setPageStep(100);
    live_->setObjectName(QStringLiteral("live"));
    live_->setToolTip(tr("Stops at this moment, or goes on with what the skin feels now (Ctrl+P)"));
    // Its ends are those of the curves above.
    const int handle = time_->style()->pixelMetric(QStyle::PM_SliderLength, nullptr, time_) / 2;
    row->setContentsMargins(TracePlot::kLeft - handle, 0, 0, 0);
    row->setSpacing(0);
    auto* right = new QWidget;
    right->setFixedWidth(TracePlot::kRight - handle);
    auto* place = new QHBoxLayout(right);
    place->setContentsMargins(10, 0, 0, 0);
    place->addWidget(ago_, 1);
    place->addWidget(live_);
    row->addWidget(time_, 1);
    row->addWidget(right);
    connect(follow_, &QCheckBox::toggled, &presenter_, &DemoPresenter::setFollowing);
    connect(time_, &QSlider::valueChanged, this,
            [this](int value) { presenter_.showAgo(std::chrono::milliseconds(-value * kTick_ms)); });
    const auto toggle = [this] { presenter_.setLive(!presenter_.isLive()); };
    connect(live_, &QPushButton::clicked, this, toggle);
    auto* key = new QShortcut(QKeySequence(Qt::CTRL | Qt::Key_P), this);
    connect(key, &QShortcut::activated, this, toggle);
    return row;
}

bool DemoPage::isTouchOn() const {
    return presenter_.isActive() && presenter_.canTouch() && touch_->isChecked();
}

bool DemoPage::isRaised() const {
    return raised_->isChecked();
}

bool DemoPage::isOrbiting() const {
    return presenter_.isActive() && orbit_->isChecked();
}

void DemoPage::setActive(bool active) {
    if (active == presenter_.isActive())
        return;
    presenter_.setActive(active);
    emit stageChanged();
}

void DemoPage::showLive() {
    contacts_->setContacts(presenter_.picture().contacts);
    showTraces();
}

void DemoPage::showTraces() {
    const Quantity quantity = presenter_.quantity();
    std::vector<TracePlot::Line> lines;
    for (auto& [place, trace] : presenter_.traces(plot_->columns())) {
        lines.push_back({tr("Module %1").arg(trace.module.value),
                         trace.shown ? textOf(*trace.shown, quantity) : QString(),
                         traceColour(place, Theme::current().isDark), std::move(trace.ranges)});
    }
    plot_->setLines(std::move(lines));
}

void DemoPage::changeEvent(QEvent* event) {
    // Curves have other colours in the dark.
    if (event->type() == QEvent::PaletteChange)
        showTraces();
    Page::changeEvent(event);
}

void DemoPage::refresh() {
    instruction_->setText(presenter_.instruction());
    const QuantityRange range = rangeOf(presenter_.quantity());
    const QString unit = unitOf(presenter_.quantity());
    curves_->setText(unit.isEmpty() ? nameOf(presenter_.quantity())
                                    : tr("%1 (%2)").arg(nameOf(presenter_.quantity()), unit));
    plot_->setScale(range.low, range.high);
    const double ago = std::chrono::duration<double>(presenter_.ago()).count();
    const bool isLive = presenter_.isLive();
    plot_->setShown(isLive ? std::nullopt : std::optional(ago));
    const QSignalBlocker timeBlocker(time_);
    const QSignalBlocker followBlocker(follow_);
    time_->setValue(-static_cast<int>(std::lround(1e3 * ago / kTick_ms)));
    ago_->setText(isLive ? tr("now") : tr("%1 s ago").arg(QLocale().toString(ago, 'f', 2)));
    follow_->setChecked(presenter_.isFollowing());
    live_->setText(isLive ? tr("Pause") : tr("Live"));
    live_->setEnabled(presenter_.hasSamples() || presenter_.isStreaming());
    if (live_->property("primary").toBool() == isLive) {
        live_->setProperty("primary", !isLive);
        live_->setStyleSheet(live_->styleSheet());  // polishes it anew
    }
    showTraces();
}

}  // namespace skincal
