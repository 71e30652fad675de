#include "ui/pages/detection_table.h"

#include <QBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSortFilterProxyModel>
#include <QTableView>

#include "ui/pages/page.h"
#include "ui/presenters/scan_presenter.h"
#include "ui/widgets/image_conversion.h"

namespace skincal {
namespace {

constexpr int kCrop_px = 64;  // on the screen

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

DetectionTable::DetectionTable(Workbench& workbench, ScanPresenter& presenter, QWidget* parent)
    : QWidget(parent),
      workbench_(workbench),
      presenter_(presenter),
      accept_(new QPushButton(tr("Accept"))),
      reject_(new QPushButton(tr("Reject"))),
      sorted_(new QSortFilterProxyModel(this)),
      table_(new QTableView),
      evidence_(mutedLabel()) {
    auto* rows = new QVBoxLayout(this);
    rows->setContentsMargins(0, 4, 0, 0);
    sorted_->setSourceModel(&presenter.detections());
    sorted_->setSortRole(DetectionModel::kSortRole);
    table_->setModel(sorted_);
    table_->setObjectName(QStringLiteral("detections"));
    table_->setAccessibleName(tr("Modules in this view"));
    table_->setToolTip(
        tr("What became of each module in this view, and why; select some to look closer or to reject them"));
    table_->setSortingEnabled(true);
    table_->sortByColumn(DetectionModel::Residual, Qt::DescendingOrder);
    table_->setSelectionBehavior(QAbstractItemView::SelectRows);
    table_->verticalHeader()->hide();
    table_->horizontalHeader()->setStretchLastSection(true);
    table_->setWordWrap(false);
    for (const int column : {DetectionModel::Module, DetectionModel::Residual, DetectionModel::Sigma})
        table_->setColumnWidth(column, 92);  // with the arrow of what it is sorted by
    table_->setColumnWidth(DetectionModel::State, 110);
    // All of the width: the reason is the longest column, and the one that is read.
    rows->addWidget(table_, 1);
    auto* below = new QHBoxLayout;
    below->setSpacing(8);
    const std::array names{tr("lit"), tr("dark"), tr("difference")};
    for (std::size_t i = 0; i < crops_.size(); ++i) {
        auto* column = new QVBoxLayout;
        crops_.at(i) = cropLabel(names.at(i));
        column->addWidget(crops_.at(i));
        auto* name = mutedLabel(names.at(i));
        name->setAlignment(Qt::AlignCenter);
        column->addWidget(name);
        column->setSpacing(2);
        below->addLayout(column);
    }
    evidence_->setObjectName(QStringLiteral("evidence"));
    evidence_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
    below->addWidget(evidence_, 1);
    auto* buttons = new QVBoxLayout;
    accept_->setObjectName(QStringLiteral("accept"));
    reject_->setObjectName(QStringLiteral("reject"));
    accept_->setToolTip(tr("Take back that you rejected the selected detections"));
    reject_->setToolTip(tr("The selected detections are no LEDs of these modules and do not count"));
    buttons->addWidget(accept_);
    buttons->addWidget(reject_);
    buttons->addStretch();
    below->addLayout(buttons);
    rows->addLayout(below);
    connect(accept_, &QPushButton::clicked, this, [this] { presenter_.detections().accept(selected()); });
    connect(reject_, &QPushButton::clicked, this, [this] { presenter_.detections().reject(selected()); });
    // Sorting anew and other views clear the selection without a word: it goes with the modules.
    connect(sorted_, &QAbstractItemModel::modelAboutToBeReset, this, [this] { kept_ = selected(); });
    connect(sorted_, &QAbstractItemModel::modelReset, this, [this] {
        QItemSelection chosen;
        for (const ModuleId module : std::exchange(kept_, {})) {
            if (const auto row = presenter_.detections().rowOf(module)) {
                const QModelIndex index = sorted_->mapFromSource(presenter_.detections().index(*row, 0));
                chosen.select(index, index);
            }
        }
        table_->selectionModel()->select(chosen, QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
        showEvidence();
        refresh();
    });
    connect(table_->selectionModel(), &QItemSelectionModel::selectionChanged, this, [this] {
        showEvidence();
        refresh();
        emit selectionChanged();
    });
}

std::vector<ModuleId> DetectionTable::selected() const {
    std::vector<ModuleId> modules;
    for (const QModelIndex& row : table_->selectionModel()->selectedRows())
        modules.push_back(
            presenter_.detections().rows()[static_cast<std::size_t>(sorted_->mapToSource(row).row())].module);
    return modules;
}

void DetectionTable::select(ModuleId module) {
    if (const auto row = presenter_.detections().rowOf(module)) {
        const QModelIndex index = sorted_->mapFromSource(presenter_.detections().index(*row, 0));
        table_->selectRow(index.row());
        table_->scrollTo(index);
    }
}

/// The word sent and the word received, as far as a line holds them.
QString DetectionTable::wordsBelowEachOther(const WordReading& reading) {
    constexpr int kLongest = 64;
    const QString sent = QString::fromStdString(reading.sent);
    const QString received = QString::fromStdString(reading.received);
    if (sent.size() > kLongest)
        return {};
    return QLatin1String("\n") + tr("sent %1\nseen %2").arg(sent, received);
}

void DetectionTable::showEvidence() {
    for (QLabel* crop : crops_)
        crop->clear();
    evidence_->clear();
    const auto modules = selected();
    if (modules.size() != 1) {
        evidence_->setText(modules.empty() ? tr("Select a module to see what decided.") : QString());
        return;
    }
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
    if (detection.reading) {
        text += QLatin1String("\n") +
                tr("Light %1 times its noise; ahead of whatever else it could be by %2 (20 is enough)")
                    .arg(detection.reading->snr, 0, 'f', 0)
                    .arg(detection.reading->margin, 0, 'f', 0) +
                wordsBelowEachOther(*detection.reading);
    }
    evidence_->setText(text);
}

void DetectionTable::refresh() {
    const auto modules = selected();
    const auto any = [&](bool isRejected) {
        return std::any_of(modules.begin(), modules.end(), [&](ModuleId module) {
            const auto row = presenter_.detections().rowOf(module);
            if (!row)
                return false;
            const DetectionRow& detection = presenter_.detections().rows()[static_cast<std::size_t>(*row)];
            // What was rejected need not have a place of its own: the picture left several.
            return isRejected ? detection.isOperatorsWord : detection.pixel && !detection.isOperatorsWord;
        });
    };
    accept_->setEnabled(any(true));
    reject_->setEnabled(any(false));
}

}  // namespace skincal
