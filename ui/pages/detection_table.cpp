#include "ui/pages/detection_table.h"

#include <QBoxLayout>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTableView>
#include <QToolButton>

#include "ui/pages/page.h"
#include "ui/pages/spot_card.h"
#include "ui/presenters/detection_filter.h"
#include "ui/presenters/scan_presenter.h"

namespace skincal {

DetectionTable::DetectionTable(Workbench& workbench, ScanPresenter& presenter, QWidget* parent)
    : QWidget(parent),
      presenter_(presenter),
      accept_(new QPushButton(tr("Accept"))),
      reject_(new QPushButton(tr("Reject"))),
      filter_(new DetectionFilter(presenter.detections(), this)),
      number_(new QLineEdit),
      doubtful_(new QCheckBox(tr("Needs a look"))),
      far_(new QCheckBox(tr("Residual above"))),
      limit_(new QDoubleSpinBox),
      count_(mutedLabel()),
      table_(new QTableView),
      card_(new SpotCard(workbench)) {
    auto* rows = new QVBoxLayout(this);
    rows->setContentsMargins(0, 4, 0, 0);
    rows->setSpacing(6);
    rows->addWidget(filterRow());
    setUpTable();
    // All of the width: the reason is the longest column, and the one that is read.
    rows->addWidget(table_, 1);
    accept_->setObjectName(QStringLiteral("accept"));
    reject_->setObjectName(QStringLiteral("reject"));
    accept_->setToolTip(tr("Take back that you rejected the selected detections"));
    reject_->setToolTip(tr("The selected detections are no LEDs of these modules and do not count"));
    card_->addButton(*accept_);
    card_->addButton(*reject_);
    rows->addWidget(card_);
    connect(accept_, &QPushButton::clicked, this, [this] { presenter_.detections().accept(selected()); });
    connect(reject_, &QPushButton::clicked, this, [this] { presenter_.detections().reject(selected()); });
    showEvidence();
    countRows();
}

QWidget* DetectionTable::filterRow() {
    auto* row = new QWidget;
    auto* parts = new QHBoxLayout(row);
    parts->setContentsMargins(0, 0, 0, 0);
    parts->setSpacing(8);
    number_->setObjectName(QStringLiteral("findModule"));
    number_->setPlaceholderText(tr("Module"));
    number_->setAccessibleName(tr("Find a module by its number"));
    number_->setToolTip(tr("Shows the modules whose number has these digits in it"));
    number_->setClearButtonEnabled(true);
    // Qt's own button in it has neither.
    if (auto* clear = number_->findChild<QToolButton*>()) {
        clear->setAccessibleName(tr("Clear the number"));
        clear->setToolTip(tr("Shows the modules of all numbers again"));
    }
    number_->setMaximumWidth(100);
    doubtful_->setObjectName(QStringLiteral("needsALook"));
    doubtful_->setToolTip(
        tr("Shows only what does not count, with the reason, and what counts with a residual above the limit"));
    far_->setObjectName(QStringLiteral("residualAbove"));
    far_->setToolTip(tr("Shows only detections farther than this from where the body has them: reject what is no LED"));
    limit_->setObjectName(QStringLiteral("residualLimit"));
    limit_->setAccessibleName(tr("Limit of the residual"));
    limit_->setToolTip(tr("Limit of the residual. A steady camera and a sound body leave some hundredths of a pixel."));
    limit_->setRange(0, 100);
    limit_->setDecimals(2);
    limit_->setSingleStep(0.1);
    limit_->setSuffix(tr(" px"));
    limit_->setValue(filter_->limit());
    count_->setObjectName(QStringLiteral("shownCount"));
    count_->setWordWrap(false);
    parts->addWidget(number_);
    parts->addWidget(doubtful_);
    parts->addWidget(far_);
    parts->addWidget(limit_);
    parts->addStretch();
    parts->addWidget(count_);
    connect(number_, &QLineEdit::textChanged, filter_, &DetectionFilter::setNumber);
    connect(doubtful_, &QCheckBox::toggled, filter_, &DetectionFilter::setDoubtfulOnly);
    connect(far_, &QCheckBox::toggled, filter_, &DetectionFilter::setFarOnly);
    connect(limit_, &QDoubleSpinBox::valueChanged, filter_, &DetectionFilter::setLimit);
    for (const auto signal : {&QAbstractItemModel::rowsInserted, &QAbstractItemModel::rowsRemoved})
        connect(filter_, signal, this, &DetectionTable::countRows);
    // A filter that hides nothing changes no rows.
    connect(number_, &QLineEdit::textChanged, this, &DetectionTable::countRows);
    for (const QCheckBox* box : {doubtful_, far_})
        connect(box, &QCheckBox::toggled, this, &DetectionTable::countRows);
    return row;
}

void DetectionTable::setUpTable() {
    table_->setModel(filter_);
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
    // Sorting anew and other views clear the selection without a word: it goes with the modules.
    connect(filter_, &QAbstractItemModel::modelAboutToBeReset, this, [this] { kept_ = selected(); });
    connect(filter_, &QAbstractItemModel::modelReset, this, [this] {
        QItemSelection chosen;
        for (const ModuleId module : std::exchange(kept_, {})) {
            if (const auto row = presenter_.detections().rowOf(module)) {
                const QModelIndex index = filter_->mapFromSource(presenter_.detections().index(*row, 0));
                if (index.isValid())
                    chosen.select(index, index);
            }
        }
        table_->selectionModel()->select(chosen, QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
        showEvidence();
        countRows();
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
        modules.push_back(filter_->rowAt(row.row()).module);
    return modules;
}

void DetectionTable::select(ModuleId module) {
    const auto row = presenter_.detections().rowOf(module);
    if (!row)
        return;
    const auto place = [&] { return filter_->mapFromSource(presenter_.detections().index(*row, 0)); };
    if (!place().isValid()) {
        number_->clear();
        doubtful_->setChecked(false);
        far_->setChecked(false);
    }
    table_->selectRow(place().row());
    table_->scrollTo(place());
}

void DetectionTable::countRows() {
    const int all = presenter_.detections().rowCount();
    count_->setText(filter_->isOn() ? tr("%1 of %2").arg(filter_->rowCount()).arg(all) : QString());
    count_->setToolTip(tr("Modules that are shown, of all modules of the skin"));
}

void DetectionTable::showEvidence() {
    const auto modules = selected();
    const auto row = modules.size() == 1 ? presenter_.detections().rowOf(modules.front()) : std::nullopt;
    if (row)
        card_->showDetection(presenter_.shownView(), presenter_.detections().rows()[static_cast<std::size_t>(*row)]);
    else
        card_->showNothing(modules.empty() ? tr("Select a module to see what decided.") : QString());
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
