#include "ui/pages/views_page.h"

#include <QEvent>
#include <QPushButton>
#include <QSplitter>

#include "ui/widgets/image_conversion.h"
#include "ui/widgets/overlap_graph.h"
#include "ui/widgets/picture_view.h"
#include "ui/widgets/primary_button.h"
#include "ui/widgets/theme.h"

namespace skincal {

ViewsPage::ViewsPage(ViewsPresenter& presenter, ScanPresenter& scan, ViewPreview& preview, QWidget* parent)
    : Page(tr("Move the camera"),
           tr("Look at the body from further places until every patch is placed. Neighbouring views should overlap."),
           parent),
      presenter_(presenter),
      scan_(scan),
      preview_(preview),
      instruction_(new QLabel),
      reason_(mutedLabel()),
      hint_(new QLabel),
      move_(new QPushButton(tr("Move the camera there"))),
      scanHere_(new QPushButton(tr("Scan from here"))),
      graph_(new OverlapGraph),
      picture_(new PictureView) {
    instruction_->setObjectName(QStringLiteral("instruction"));
    instruction_->setWordWrap(true);
    keepTwoLines(*instruction_);
    body().addWidget(instruction_);
    body().addWidget(reason_);
    auto* buttons = new QHBoxLayout;
    move_->setObjectName(QStringLiteral("moveCamera"));
    move_->setToolTip(tr(
        "The simulated rig carries its camera to the suggested place, shown in the 3D view; while patches are missing, "
        "to the next of its own places"));
    scanHere_->setObjectName(QStringLiteral("scanHere"));
    scanHere_->setToolTip(tr("Take a new view from where the camera stands now"));
    buttons->addWidget(move_);
    buttons->addWidget(scanHere_);
    buttons->addStretch();
    body().addLayout(buttons);
    hint_->setObjectName(QStringLiteral("hint"));
    hint_->setAccessibleName(tr("Whether the picture would do"));
    hint_->setToolTip(tr(
        "The patches light up one after the other, and their spots are counted in the picture: a scan from here would "
        "find about as many"));
    hint_->setWordWrap(true);
    body().addWidget(hint_);
    picture_->setPlaceholder(tr("No picture: choose a camera first."));
    picture_->setToolTip(
        tr("What the camera sees now. Rings: spots of the patches, in the patch's colour, that a scan from here would "
           "find."));
    auto* splitter = new QSplitter(Qt::Vertical);
    splitter->addWidget(picture_);
    splitter->addWidget(graph_);
    splitter->setStretchFactor(0, 3);
    splitter->setStretchFactor(1, 2);
    splitter->setChildrenCollapsible(false);
    body().addWidget(splitter, 1);

    connect(move_, &QPushButton::clicked, this, [this] {
        hasMoved_ = true;
        presenter_.moveCamera();
        // What was seen from the old place holds no more.
        preview_.setActive(false);
        preview_.setActive(isActive_);
        refresh();
    });
    connect(&scan, &ScanPresenter::scanned, this, [this] {
        hasMoved_ = false;
        refresh();
    });
    connect(scanHere_, &QPushButton::clicked, this, &ViewsPage::scanAsked);
    connect(&presenter, &ViewsPresenter::changed, this, &ViewsPage::refresh);
    connect(&scan, &ScanPresenter::stateChanged, this, &ViewsPage::refresh);
    connect(&preview, &ViewPreview::changed, this, &ViewsPage::showHint);
    connect(&scan, &ScanPresenter::pictureChanged, this, [this] {
        if (isActive_)
            picture_->setImage(toImage(scan_.picture()));
    });
    refresh();
    showHint();
}

void ViewsPage::setActive(bool active) {
    isActive_ = active;
    scan_.setActive(active);
    preview_.setActive(active);
    refresh();
}

void ViewsPage::changeEvent(QEvent* event) {
    // The hint's colour is one of the theme's.
    if (event->type() == QEvent::PaletteChange)
        showHint();
    Page::changeEvent(event);
}

void ViewsPage::refresh() {
    const bool isEnough = presenter_.isEnough();
    const QString instruction = presenter_.instruction();
    instruction_->setText(isEnough ? tr("✓ %1").arg(instruction) : instruction);
    move_->setText(presenter_.goesToTarget() ? tr("Move the camera there") : tr("Move the camera on"));
    reason_->setText(presenter_.reason());
    reason_->setVisible(!presenter_.reason().isEmpty());
    graph_->setGraph(presenter_.views(), presenter_.patches());
    const QString obstacle = scan_.obstacle();
    scanHere_->setEnabled(obstacle.isEmpty() && !scan_.state().isRunning());
    scanHere_->setStatusTip(obstacle);
    // A second view from the same place tells next to nothing.
    const bool isMoveNext = presenter_.hasHands() && !hasMoved_;
    move_->setVisible(presenter_.hasHands());
    setPrimary(move_, isMoveNext && !isEnough);
    setPrimary(scanHere_, !isMoveNext && !isEnough);
    showHint();
}

void ViewsPage::showHint() {
    const Theme theme = Theme::current();
    QString text = preview_.words();
    const QString obstacle = scan_.obstacle();
    hint_->setText(!text.isEmpty()       ? text
                   : !obstacle.isEmpty() ? obstacle
                                         : tr("Looking which patches are in the picture …"));
    const bool isGood = preview_.verdict() == ViewPreview::Verdict::Good;
    const QColor colour = text.isEmpty() ? theme.muted : isGood ? theme.good : theme.attention;
    hint_->setStyleSheet(QStringLiteral("color: %1").arg(colour.name()));
    std::vector<PictureMark> marks;
    for (const SpotInSight& spot : preview_.spots())
        marks.push_back(
            {QPointF(spot.pixel.x(), spot.pixel.y()), patchTint(preview_.patches()[spot.patch].patch.value)});
    picture_->setMarks(std::move(marks));
}

}  // namespace skincal
