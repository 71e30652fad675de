#include "ui/pages/scan_page.h"

#include <QComboBox>
#include <QHeaderView>
#include <QProgressBar>
#include <QPushButton>
#include <QSortFilterProxyModel>
#include <QSplitter>
#include <QTableView>

#include "ui/widgets/image_conversion.h"
#include "ui/widgets/picture_view.h"

namespace skincal {
namespace {

using Phase = ScanRun::Phase;

constexpr int kCrop_px = 84;  // on the screen

/// On a picture, which is dark whatever the theme.
const QColor kUsed("#56c8ff");
const QColor kSetAside("#ffb020");

/// The first entry of the list of views: what the camera sees now.
constexpr int kLive = 0;

QLabel* cropLabel(const QString& name) {
    auto* label = new QLabel;
    label->setFixedSize(kCrop_px, kCrop_px);
    label->setAlignment(Qt::AlignCenter);
    label->setFrameShape(QFrame::StyledPanel);
    label->setAccessibleName(name);
    label->setToolTip(name);
    return label;
}

}  // namespace

ScanPage::ScanPage(Workbench& workbench, ScanPresenter& presenter, QWidget* parent)
    : Page(tr("Scan"),
           tr("Every module blinks a word of its own before the camera. Hold camera and body still meanwhile."),
           parent),
      workbench_(workbench),
      presenter_(presenter),
      picture_(new PictureView),
      views_(new QComboBox),
      start_(new QPushButton(tr("Scan this view"))),
      pause_(new QPushButton(tr("Pause"))),
      again_(new QPushButton(tr("Scan again"))),
      dropView_(new QPushButton(tr("Drop view"))),
      accept_(new QPushButton(tr("Accept"))),
      reject_(new QPushButton(tr("Reject"))),
      progress_(new QProgressBar),
      status_(mutedLabel()),
      sorted_(new QSortFilterProxyModel(this)),
      table_(new QTableView),
      summary_(mutedLabel()),
      evidence_(mutedLabel()) {
    auto* top = new QHBoxLayout;
    start_->setObjectName(QStringLiteral("scan"));
    start_->setProperty("primary", true);
    start_->setToolTip(tr("Take the pictures of a new view from where the camera stands"));
    pause_->setObjectName(QStringLiteral("pause"));
    top->addWidget(start_);
    top->addWidget(pause_);
    top->addWidget(progress_, 1);
    top->addStretch();
    progress_->setAccessibleName(tr("Progress of the scan"));
    body().addLayout(top);
    body().addWidget(status_);

    auto* row = new QHBoxLayout;
    row->addWidget(mutedLabel(tr("Show")));
    views_->setObjectName(QStringLiteral("views"));
    views_->setAccessibleName(tr("View"));
    views_->setToolTip(tr("The camera's picture now, or a view that was scanned"));
    row->addWidget(views_);
    row->addWidget(summary_, 1);
    again_->setToolTip(tr("Scan in the place of the shown view; the camera must stand where it stood"));
    dropView_->setObjectName(QStringLiteral("dropView"));
    dropView_->setToolTip(tr("The shown view no longer counts; undo brings it back"));
    row->addWidget(again_);
    row->addWidget(dropView_);
    body().addLayout(row);

    picture_->setPlaceholder(tr("No picture yet."));
    auto* below = new QWidget;
    auto* columns = new QHBoxLayout(below);
    columns->setContentsMargins(0, 4, 0, 0);
    sorted_->setSourceModel(&presenter.detections());
    sorted_->setSortRole(DetectionModel::kSortRole);
    table_->setModel(sorted_);
    table_->setObjectName(QStringLiteral("detections"));
    table_->setAccessibleName(tr("Modules in this view"));
    table_->setSortingEnabled(true);
    table_->sortByColumn(DetectionModel::Residual, Qt::DescendingOrder);
    table_->setSelectionBehavior(QAbstractItemView::SelectRows);
    table_->verticalHeader()->hide();
    table_->horizontalHeader()->setStretchLastSection(true);
    table_->setWordWrap(false);
    for (const int column : {DetectionModel::Module, DetectionModel::Residual, DetectionModel::Sigma})
        table_->setColumnWidth(column, 76);
    table_->setColumnWidth(DetectionModel::State, 96);
    columns->addWidget(table_, 1);
    auto* side = new QVBoxLayout;
    auto* crops = new QHBoxLayout;
    const std::array names{tr("lit"), tr("dark"), tr("difference")};
    for (std::size_t i = 0; i < crops_.size(); ++i) {
        auto* column = new QVBoxLayout;
        crops_.at(i) = cropLabel(names.at(i));
        column->addWidget(crops_.at(i));
        auto* name = mutedLabel(names.at(i));
        name->setAlignment(Qt::AlignCenter);
        column->addWidget(name);
        crops->addLayout(column);
    }
    side->addLayout(crops);
    side->addWidget(evidence_);
    side->addStretch();
    auto* buttons = new QHBoxLayout;
    accept_->setObjectName(QStringLiteral("accept"));
    reject_->setObjectName(QStringLiteral("reject"));
    accept_->setToolTip(tr("Take back that you rejected the selected detections"));
    reject_->setToolTip(tr("The selected detections are no LEDs of these modules and do not count"));
    buttons->addWidget(accept_);
    buttons->addWidget(reject_);
    side->addLayout(buttons);
    columns->addLayout(side);
    auto* splitter = new QSplitter(Qt::Vertical);
    splitter->addWidget(picture_);
    splitter->addWidget(below);
    splitter->setStretchFactor(0, 3);
    splitter->setStretchFactor(1, 2);
    splitter->setChildrenCollapsible(false);
    body().addWidget(splitter, 1);

    connect(start_, &QPushButton::clicked, this, [this] {
        const Phase phase = presenter_.state().phase;
        if (presenter_.state().isRunning() || phase == Phase::Paused || phase == Phase::Decoding) {
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
    connect(accept_, &QPushButton::clicked, this, [this] { presenter_.detections().accept(selected()); });
    connect(reject_, &QPushButton::clicked, this, [this] { presenter_.detections().reject(selected()); });
    connect(views_, &QComboBox::currentIndexChanged, this, [this](int index) {
        if (index > kLive)
            presenter_.showView(views_->itemText(index).toStdString());
        showPicture();
        showMarks();
        refresh();
    });
    connect(&presenter, &ScanPresenter::stateChanged, this, &ScanPage::refresh);
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
    connect(picture_, &PictureView::markClicked, this, &ScanPage::select);
    connect(table_->selectionModel(), &QItemSelectionModel::selectionChanged, this, [this] {
        showEvidence();
        refresh();
    });
    listViews();
    refresh();
}

void ScanPage::setActive(bool active) {
    isActive_ = active;
    presenter_.setActive(active);
    refresh();
}

std::vector<ModuleId> ScanPage::selected() const {
    std::vector<ModuleId> modules;
    for (const QModelIndex& row : table_->selectionModel()->selectedRows())
        modules.push_back(
            presenter_.detections().rows()[static_cast<std::size_t>(sorted_->mapToSource(row).row())].module);
    return modules;
}

void ScanPage::select(ModuleId module) {
    if (const auto row = presenter_.detections().rowOf(module)) {
        const QModelIndex index = sorted_->mapFromSource(presenter_.detections().index(*row, 0));
        table_->selectRow(index.row());
        table_->scrollTo(index);
    }
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
        picture_->setImage(toImage((*view->pictures)[1]));
    else
        picture_->setImage({});
}

void ScanPage::showMarks() {
    std::vector<PictureMark> marks;
    if (views_->currentIndex() > kLive) {
        for (const DetectionRow& row : presenter_.detections().rows()) {
            if (!row.pixel)
                continue;
            const bool counts = row.state == DetectionRow::State::Used;
            marks.push_back({QPointF(row.pixel->x(), row.pixel->y()), counts ? kUsed : kSetAside, row.module, !counts});
        }
    }
    picture_->setMarks(std::move(marks));
}

void ScanPage::showEvidence() {
    for (QLabel* crop : crops_)
        crop->clear();
    evidence_->clear();
    const auto modules = selected();
    if (modules.size() != 1) {
        picture_->setSelected(std::nullopt);
        evidence_->setText(modules.empty() ? tr("Select a module to see what decided.") : QString());
        return;
    }
    picture_->setSelected(modules.front());
    emit moduleSelected(modules.front());
    const auto row = presenter_.detections().rowOf(modules.front());
    const ScannedView* view = workbench_.session().findView(presenter_.shownView());
    if (!row || view == nullptr)
        return;
    const DetectionRow& detection = presenter_.detections().rows()[static_cast<std::size_t>(*row)];
    if (!detection.pixel) {
        evidence_->setText(detection.reason);
        return;
    }
    const auto evidence = evidenceOf(*view, detection.module, *detection.pixel);
    if (!evidence) {
        evidence_->setText(tr("This view was recorded without pictures."));
        return;
    }
    const std::array pictures{evidence->lit, evidence->dark, evidence->difference};
    for (std::size_t i = 0; i < pictures.size(); ++i)
        crops_.at(i)->setPixmap(QPixmap::fromImage(toImage(pictures.at(i)))
                                    .scaled(kCrop_px - 4, kCrop_px - 4, Qt::KeepAspectRatio, Qt::FastTransformation));
    QString text = tr("Module %1: %2 grey levels between on and off, centre at (%3, %4) px")
                       .arg(detection.module.value)
                       .arg(evidence->contrast, 0, 'f', 0)
                       .arg(detection.pixel->x(), 0, 'f', 2)
                       .arg(detection.pixel->y(), 0, 'f', 2);
    if (!detection.reason.isEmpty())
        text += tr("; %1").arg(detection.reason);
    evidence_->setText(text);
}

void ScanPage::refresh() {
    const ScanRun& state = presenter_.state();
    const bool isBusy = state.isRunning() || state.phase == Phase::Paused || state.phase == Phase::Decoding;
    const QString obstacle = presenter_.obstacle();
    start_->setText(isBusy ? tr("Cancel") : tr("Scan this view"));
    start_->setEnabled(isBusy || obstacle.isEmpty());
    pause_->setText(state.phase == Phase::Paused ? tr("Resume") : tr("Pause"));
    pause_->setEnabled(state.isRunning() || state.phase == Phase::Paused);
    pause_->setToolTip(tr("Stop between two pictures, and go on later"));
    progress_->setVisible(isBusy);
    progress_->setValue(static_cast<int>(100 * presenter_.done()));
    QString text;
    if (state.phase == Phase::Decoding)
        text = tr("Decoding …");
    else if (state.phase == Phase::Paused)
        text = tr("Paused after picture %1 of %2").arg(state.next).arg(state.frames);
    else if (state.isRunning()) {
        text = tr("Picture %1 of %2").arg(state.next + 1).arg(state.frames);
        if (const auto left = presenter_.timeLeft())
            text += tr(", %1 s left").arg(std::chrono::duration<double>(*left).count(), 0, 'f', 0);
    } else if (state.phase == Phase::Failed)
        text = tr("Broken off: %1").arg(QString::fromStdString(state.why));
    else
        text = obstacle.isEmpty() ? tr("Ready: %n pictures of this view will be taken.", nullptr,
                                       static_cast<int>(presenter_.picturesOfAScan()))
                                  : obstacle;
    status_->setText(text);

    const bool isView = views_->currentIndex() > kLive;
    const auto& rows = presenter_.detections().rows();
    const auto used = std::count_if(rows.begin(), rows.end(),
                                    [](const DetectionRow& row) { return row.state == DetectionRow::State::Used; });
    const bool isDropped = workbench_.session().decisions().droppedViews.contains(presenter_.shownView());
    summary_->setText(isView ? (isDropped ? tr("dropped") : tr("%1 of %2 modules count").arg(used).arg(rows.size()))
                             : QString());
    again_->setEnabled(isView && !isBusy && obstacle.isEmpty());
    dropView_->setEnabled(isView && !isBusy);
    dropView_->setText(isDropped ? tr("Take view back") : tr("Drop view"));
    const auto modules = selected();
    const auto any = [&](bool isRejected) {
        return std::any_of(modules.begin(), modules.end(), [&](ModuleId module) {
            const auto row = presenter_.detections().rowOf(module);
            if (!row)
                return false;
            const DetectionRow& detection = rows[static_cast<std::size_t>(*row)];
            return detection.pixel.has_value() && detection.isOperatorsWord == isRejected;
        });
    };
    accept_->setEnabled(any(true));
    reject_->setEnabled(any(false));
}

}  // namespace skincal
