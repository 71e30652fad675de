#include "ui/pages/scan_page.h"

#include <QCheckBox>
#include <QComboBox>
#include <QProgressBar>
#include <QPushButton>
#include <QSplitter>

#include "ui/pages/detection_table.h"
#include "ui/presenters/spot_evidence.h"
#include "ui/widgets/image_conversion.h"
#include "ui/widgets/picture_view.h"

namespace skincal {
namespace {

using Phase = ScanRun::Phase;

/// On a picture, which is dark whatever the theme.
const QColor kUsed("#56c8ff");
const QColor kSetAside("#ffb020");

const QColor kStray("#9aa0aa");

/// The first entry of the list of views: what the camera sees now.
constexpr int kLive = 0;

/// The fainter the spot, the fainter its mark.
std::vector<PictureMark> liveMarks(const std::vector<LiveSpot>& spots) {
    constexpr double kStrong = 60;  // grey levels
    std::vector<PictureMark> marks;
    for (const LiveSpot& spot : spots) {
        QColor colour = spot.module ? kUsed : spot.possible > 0 ? kSetAside : kStray;
        colour.setAlphaF(static_cast<float>(std::clamp(spot.contrast / kStrong, 0.4, 1.0)));
        PictureMark mark{QPointF(spot.pixel.x(), spot.pixel.y()), colour, spot.module};
        mark.isCrossed = spot.possible == 0;
        mark.isNamed = spot.module.has_value();
        marks.push_back(std::move(mark));
    }
    return marks;
}

/// " (3, 17)", where they are few.
QString namesOf(const std::vector<ModuleId>& modules) {
    constexpr std::size_t kMost = 6;
    QStringList names;
    for (const ModuleId module : modules)
        names << QString::number(module.value);
    return names.size() > static_cast<qsizetype>(kMost) ? QString()
                                                        : QStringLiteral(" (%1)").arg(names.join(QStringLiteral(", ")));
}

}  // namespace

ScanPage::ScanPage(Workbench& workbench, ScanPresenter& presenter, QWidget* parent)
    : Page(tr("Scan"), tr("LEDs are told apart by how they blink. Hold camera and body still meanwhile."), parent),
      workbench_(workbench),
      presenter_(presenter),
      picture_(new PictureView),
      views_(new QComboBox),
      start_(new QPushButton(tr("Scan this view"))),
      pause_(new QPushButton(tr("Pause"))),
      code_(new QComboBox),
      again_(new QPushButton(tr("Scan again"))),
      dropView_(new QPushButton(tr("Drop view"))),
      progress_(new QProgressBar),
      status_(mutedLabel()),
      table_(new DetectionTable(workbench, presenter)),
      summary_(mutedLabel()) {
    auto* top = new QHBoxLayout;
    start_->setObjectName(QStringLiteral("scan"));
    start_->setProperty("primary", true);
    start_->setToolTip(tr("Take the pictures of a new view from where the camera stands"));
    pause_->setObjectName(QStringLiteral("pause"));
    top->addWidget(start_);
    top->addWidget(pause_);
    code_->setObjectName(QStringLiteral("code"));
    code_->setAccessibleName(tr("How modules are told apart"));
    code_->addItem(tr("By words"), static_cast<int>(ScanCode::Words));
    code_->addItem(tr("One at a time"), static_cast<int>(ScanCode::OneAtATime));
    code_->setToolTip(
        tr("By words: all LEDs blink at once, each its own word; a second or two for thousands of modules, and what "
           "disturbs a picture is made up for.\nOne at a time: each LED alone between dark pictures; takes long, and "
           "shows the pictures of every single LED."));
    connect(code_, &QComboBox::currentIndexChanged, this,
            [this] { presenter_.setCode(static_cast<ScanCode>(code_->currentData().toInt())); });
    top->addWidget(code_);
    auto* looksAgain = new QCheckBox(tr("Look again"));
    looksAgain->setObjectName(QStringLiteral("looksAgain"));
    looksAgain->setChecked(presenter.looksAgain());
    looksAgain->setToolTip(tr(
        "After the scan, modules that were missed although something shines there are lit again in smaller groups, and "
        "what a knock of the camera spoilt is repeated: up to 300 pictures more"));
    connect(looksAgain, &QCheckBox::toggled, this, [this](bool again) { presenter_.setLooksAgain(again); });
    top->addWidget(looksAgain);
    top->addWidget(progress_, 1);
    top->addStretch();
    progress_->setObjectName(QStringLiteral("scanProgress"));
    progress_->setAccessibleName(tr("Progress of the scan"));
    progress_->setToolTip(
        tr("How many of this view's pictures are taken; hold camera and body still until it is full"));
    body().addLayout(top);
    body().addWidget(status_);

    auto* row = new QHBoxLayout;
    row->addWidget(mutedLabel(tr("Show")));
    views_->setObjectName(QStringLiteral("views"));
    views_->setAccessibleName(tr("View"));
    views_->setToolTip(tr("The camera's picture now, or a view that was scanned"));
    row->addWidget(views_);
    row->addWidget(summary_, 1);
    again_->setObjectName(QStringLiteral("scanAgain"));
    again_->setToolTip(
        tr("Scan from where the camera stands now, in the place of the shown view. What you decided about its "
           "detections is forgotten; undo brings both back."));
    dropView_->setObjectName(QStringLiteral("dropView"));
    dropView_->setToolTip(tr("The shown view no longer counts; undo brings it back"));
    row->addWidget(again_);
    row->addWidget(dropView_);
    body().addLayout(row);

    picture_->setPlaceholder(tr("No picture yet."));
    picture_->setToolTip(tr("Rings: spots that were found; crossed ones do not count. Click one to see why."));
    auto* splitter = new QSplitter(Qt::Vertical);
    splitter->addWidget(picture_);
    splitter->addWidget(table_);
    splitter->setStretchFactor(0, 1);
    splitter->setStretchFactor(1, 1);
    splitter->setSizes({210, 340});
    splitter->setChildrenCollapsible(false);
    body().addWidget(splitter, 1);

    connect(start_, &QPushButton::clicked, this, [this] {
        if (presenter_.isBusy()) {
            presenter_.cancel();
            return;
        }
        views_->setCurrentIndex(kLive);
        presenter_.start();
    });
    connect(pause_, &QPushButton::clicked, this,
            [this] { presenter_.state().phase == Phase::Paused ? presenter_.resume() : presenter_.pause(); });
    connect(again_, &QPushButton::clicked, this, [this] { presenter_.start(presenter_.shownView()); });
    connect(dropView_, &QPushButton::clicked, this, [this] {
        const std::string& view = presenter_.shownView();
        presenter_.setDropped(view, !workbench_.session().decisions().droppedViews.contains(view));
    });
    connect(views_, &QComboBox::currentIndexChanged, this, [this](int index) {
        if (index > kLive)
            presenter_.showView(views_->itemText(index).toStdString());
        showPicture();
        showMarks();
        refresh();
    });
    connect(&presenter, &ScanPresenter::stateChanged, this, [this] {
        // Whoever started it, it is what there is to see.
        if (!std::exchange(wasBusy_, presenter_.isBusy()) && presenter_.isBusy())
            views_->setCurrentIndex(kLive);
        refresh();
    });
    connect(&presenter, &ScanPresenter::spotsChanged, this, [this] {
        showMarks();
        refresh();
    });
    connect(&presenter, &ScanPresenter::pictureChanged, this, [this] {
        if (isActive_ && views_->currentIndex() <= kLive) {
            showPicture();
            if (presenter_.state().phase == Phase::Idle)
                refresh();
        }
    });
    connect(&presenter, &ScanPresenter::shownViewChanged, this, &ScanPage::listViews);
    connect(&workbench.session(), &Session::viewsChanged, this, &ScanPage::listViews);
    connect(&presenter.detections(), &QAbstractItemModel::modelReset, this, [this] {
        showMarks();
        refresh();
    });
    connect(picture_, &PictureView::markClicked, table_, &DetectionTable::select);
    connect(table_, &DetectionTable::selectionChanged, this, [this] {
        const auto modules = table_->selected();
        picture_->setSelected(modules.size() == 1 ? std::optional(modules.front()) : std::nullopt);
        if (modules.size() == 1)
            emit moduleSelected(modules.front());
    });
    listViews();
    refresh();
}

void ScanPage::setActive(bool active) {
    isActive_ = active;
    presenter_.setActive(active);
    refresh();
}

void ScanPage::listViews() {
    const QSignalBlocker blocker(views_);
    views_->clear();
    views_->addItem(tr("Camera now"));
    int shown = kLive;
    for (const ScannedView& view : workbench_.session().measured().views) {
        views_->addItem(QString::fromStdString(view.name));
        if (view.name == presenter_.shownView())
            shown = views_->count() - 1;
    }
    views_->setCurrentIndex(shown);
    showPicture();
    showMarks();
    refresh();
}

void ScanPage::showPicture() {
    if (views_->currentIndex() <= kLive) {
        picture_->setImage(toImage(presenter_.picture()));
        return;
    }
    const ScannedView* view = workbench_.session().findView(presenter_.shownView());
    // The second picture of a coded scan has all LEDs on.
    if (view != nullptr && view->pictures && view->pictures->size() > 1)
        picture_->setImage(toImage(pictureOf(*view)));
    else
        picture_->setImage({});
}

void ScanPage::showMarks() {
    std::vector<PictureMark> marks;
    if (views_->currentIndex() <= kLive) {
        if (presenter_.isBusy())
            marks = liveMarks(presenter_.spots());
    } else {
        for (const DetectionRow& row : presenter_.detections().rows()) {
            if (!row.pixel)
                continue;
            const bool counts = row.state == DetectionRow::State::Used;
            marks.push_back({QPointF(row.pixel->x(), row.pixel->y()), counts ? kUsed : kSetAside, row.module, !counts});
        }
    }
    picture_->setMarks(std::move(marks));
}

void ScanPage::refresh() {
    const ScanRun& state = presenter_.state();
    const bool isBusy = presenter_.isBusy();
    const QString obstacle = presenter_.obstacle();
    start_->setText(!isBusy ? tr("Scan this view") : presenter_.wanted().empty() ? tr("Cancel") : tr("Enough"));
    start_->setEnabled(isBusy || obstacle.isEmpty());
    pause_->setText(state.phase == Phase::Paused ? tr("Resume") : tr("Pause"));
    pause_->setEnabled(state.isRunning() || state.phase == Phase::Paused);
    code_->setEnabled(!isBusy);
    pause_->setToolTip(tr("Stop between two pictures, and go on later"));
    progress_->setVisible(isBusy);
    progress_->setValue(static_cast<int>(100 * presenter_.done()));
    QString text;
    if (state.phase == Phase::Decoding) {
        text = tr("Decoding …");
    } else if (state.phase == Phase::Paused) {
        text = tr("Paused after picture %1 of %2").arg(state.taken()).arg(state.frames);
    } else if (state.isRunning()) {
        const auto& spots = presenter_.spots();
        const auto known = std::count_if(spots.begin(), spots.end(), [](const LiveSpot& spot) { return spot.module; });
        const auto& wanted = presenter_.wanted();
        text = tr("Picture %1 of %2").arg(state.taken() + 1).arg(state.frames);
        if (!wanted.empty())
            text = tr("Looking again for %n modules", nullptr, static_cast<int>(wanted.size())) + namesOf(wanted) +
                   tr(": ") + text;
        else if (!spots.empty())
            text += tr(", %n spots", nullptr, static_cast<int>(spots.size())) + tr(", %1 of them known").arg(known);
        if (const auto left = presenter_.timeLeft())
            text += tr(", %1 s left").arg(std::chrono::duration<double>(*left).count(), 0, 'f', 0);
        if (const auto moved = presenter_.movedSoFar_px())
            text = (presenter_.looksAgain()
                        ? tr("The camera moved by %1 px: hold it still, what that spoilt is scanned again.")
                        : tr("The camera moved by %1 px: cancel, and scan again with camera and body at rest."))
                       .arg(*moved, 0, 'f', 1) +
                   QLatin1Char(' ') + text;
    } else if (state.phase == Phase::Failed) {
        text = presenter_.isKept() ? tr("Broken off: %1. What was found before is kept as %2.")
                                         .arg(presenter_.why(), QString::fromStdString(presenter_.shownView()))
                                   : tr("Broken off: %1").arg(presenter_.why());
    } else {
        text = obstacle.isEmpty() ? tr("Ready: %n pictures of this view will be taken.", nullptr,
                                       static_cast<int>(presenter_.picturesOfAScan()))
                                  : obstacle;
    }
    status_->setText(text);

    const bool isView = views_->currentIndex() > kLive;
    table_->refresh();
    const auto& rows = presenter_.detections().rows();
    const auto used = std::count_if(rows.begin(), rows.end(),
                                    [](const DetectionRow& row) { return row.state == DetectionRow::State::Used; });
    const bool isDropped = workbench_.session().decisions().droppedViews.contains(presenter_.shownView());
    summary_->setText(isView ? (isDropped ? tr("dropped") : tr("%1 of %2 modules count").arg(used).arg(rows.size()))
                             : QString());
    again_->setEnabled(isView && !isBusy && obstacle.isEmpty());
    dropView_->setEnabled(isView && !isBusy);
    dropView_->setText(isDropped ? tr("Take view back") : tr("Drop view"));
}

}  // namespace skincal
