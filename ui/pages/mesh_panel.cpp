#include "ui/pages/mesh_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QEvent>
#include <QFileDialog>
#include <QHeaderView>
#include <QLabel>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QTableWidget>
#include <algorithm>
#include <cmath>

#include "ui/pages/mesh_words.h"
#include "ui/pages/page.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

QTableWidget* plainTable(const QString& name, const QString& accessible) {
    auto* table = new QTableWidget;
    table->setObjectName(name);
    table->setAccessibleName(accessible);
    table->verticalHeader()->hide();
    table->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table->horizontalHeader()->setStretchLastSection(true);
    return table;
}

QTableWidgetItem* numberItem(const QString& text) {
    auto* item = new QTableWidgetItem(text);
    item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
    return item;
}

enum Column { kModule, kDeviation, kAngle, kColumns };

}  // namespace

MeshPanel::MeshPanel(MeshPresenter& presenter, QWidget* parent)
    : QWidget(parent),
      presenter_(presenter),
      open_(new QPushButton(tr("Compare with a mesh …"))),
      simulated_(new QPushButton(tr("Simulated body"))),
      remove_(new QPushButton(tr("Remove mesh"))),
      unit_(new QComboBox),
      offset_(new QCheckBox(tr("Modules stand off"))),
      verdict_(new QLabel),
      reason_(mutedLabel()),
      busy_(new QProgressBar),
      drop_(new QLabel(tr("Drop an STL file here, or anywhere on the window"))),
      result_(new QWidget),
      figures_(plainTable(QStringLiteral("meshFigures"), tr("Agreement with the mesh"))),
      modules_(plainTable(QStringLiteral("deviations"), tr("Modules by deviation"))),
      doubts_(new QListWidget) {
    open_->setObjectName(QStringLiteral("openMesh"));
    open_->setToolTip(
        tr("Choose a surface of the body (STL), such as its drawing; one can also be dropped on the "
           "window"));
    simulated_->setObjectName(QStringLiteral("simulatedBody"));
    simulated_->setToolTip(tr("Compare with the true surface of the simulated body"));
    simulated_->setVisible(presenter.hasSimulatedBody());
    remove_->setObjectName(QStringLiteral("removeMesh"));
    remove_->setToolTip(tr("Forget the mesh: the 3D view shows the body alone again"));
    unit_->setObjectName(QStringLiteral("meshUnit"));
    unit_->setAccessibleName(tr("Unit of the mesh"));
    unit_->setToolTip(
        tr("STL files do not say what their numbers are; chosen by the size of the body where you do "
           "not know"));
    unit_->addItem(tr("Unit by size"));
    unit_->addItem(tr("Millimetres"), static_cast<int>(MeshUnit::Millimetre));
    unit_->addItem(tr("Metres"), static_cast<int>(MeshUnit::Metre));
    offset_->setObjectName(QStringLiteral("meshOffset"));
    offset_->setToolTip(
        tr("Boards and their carrier have a thickness: finds by how much all modules lie above the "
           "surface together, and leaves it out of the deviations"));
    offset_->setChecked(presenter.isOffsetFitted());
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(open_);
    buttons->addWidget(simulated_);
    buttons->addWidget(remove_);
    buttons->addStretch();
    auto* choices = new QHBoxLayout;
    choices->addWidget(unit_);
    choices->addWidget(offset_);
    choices->addStretch();
    verdict_->setObjectName(QStringLiteral("instruction"));
    verdict_->setWordWrap(true);
    busy_->setRange(0, 0);
    busy_->setAccessibleName(tr("Comparing"));
    busy_->setToolTip(tr("The body is being laid on the mesh; you can go on meanwhile"));

    figures_->setToolTip(tr("How well body and mesh agree, and by how much all modules stand off together"));
    figures_->setColumnCount(2);
    figures_->horizontalHeader()->hide();
    figures_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    figures_->setSelectionMode(QAbstractItemView::NoSelection);
    modules_->setColumnCount(kColumns);
    modules_->setHorizontalHeaderLabels({tr("Module"), tr("Above"), tr("Tilt")});
    for (const int column : {kModule, kDeviation})
        modules_->horizontalHeader()->setSectionResizeMode(column, QHeaderView::ResizeToContents);
    modules_->horizontalHeaderItem(kDeviation)
        ->setToolTip(
            tr("How far the module's middle lies above where the mesh and the common stand-off would have it"));
    modules_->horizontalHeaderItem(kAngle)->setToolTip(tr("Angle between the module's normal and the mesh's"));
    modules_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    figures_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    modules_->setSelectionBehavior(QAbstractItemView::SelectRows);
    modules_->setSelectionMode(QAbstractItemView::SingleSelection);
    modules_->setToolTip(tr("The modules that lie farthest off come first; select one to see it in the 3D view"));
    doubts_->setObjectName(QStringLiteral("meshDoubts"));
    doubts_->setAccessibleName(tr("What to know about the comparison"));
    doubts_->setToolTip(tr("What makes the comparison doubtful, such as another pose that fits as well"));
    doubts_->setWordWrap(true);
    doubts_->setSelectionMode(QAbstractItemView::NoSelection);
    doubts_->setSpacing(2);
    doubts_->setMinimumHeight(64);
    drop_->setAlignment(Qt::AlignCenter);
    drop_->setMinimumHeight(140);
    auto* results = new QVBoxLayout(result_);
    results->setContentsMargins(0, 0, 0, 0);
    auto* tables = new QHBoxLayout;
    tables->addWidget(figures_, 5);
    tables->addWidget(modules_, 4);
    results->addLayout(tables, 4);
    results->addWidget(mutedLabel(tr("What to know about it:")));
    results->addWidget(doubts_, 1);

    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(12, 12, 12, 12);
    column->setSpacing(8);
    column->addLayout(buttons);
    column->addLayout(choices);
    column->addWidget(verdict_);
    column->addWidget(reason_);
    column->addWidget(busy_);
    column->addWidget(drop_, 1);
    column->addWidget(result_, 1);
    column->addStretch();

    connect(open_, &QPushButton::clicked, this, &MeshPanel::choose);
    connect(simulated_, &QPushButton::clicked, &presenter, &MeshPresenter::useSimulatedBody);
    connect(remove_, &QPushButton::clicked, &presenter, &MeshPresenter::remove);
    connect(unit_, &QComboBox::currentIndexChanged, this, [this] {
        const QVariant unit = unit_->currentData();
        presenter_.setUnit(unit.isValid() ? std::optional(static_cast<MeshUnit>(unit.toInt())) : std::nullopt);
    });
    connect(offset_, &QCheckBox::toggled, &presenter, &MeshPresenter::setOffsetFitted);
    connect(&presenter, &MeshPresenter::changed, this, &MeshPanel::refresh);
    connect(modules_, &QTableWidget::itemSelectionChanged, this, [this] {
        if (!modules_->selectedItems().isEmpty())
            emit moduleSelected(ModuleId{modules_->item(modules_->currentRow(), kModule)->text().toUInt()});
    });
    refresh();
}

void MeshPanel::changeEvent(QEvent* event) {
    if (event->type() == QEvent::PaletteChange)
        refresh();
    QWidget::changeEvent(event);
}

void MeshPanel::choose() {
    const QString file = QFileDialog::getOpenFileName(this, tr("Compare with a mesh"), {}, tr("Meshes (*.stl *.STL)"));
    if (!file.isEmpty())
        presenter_.open(file);
}

void MeshPanel::refresh() {
    const auto& comparison = presenter_.comparison();
    const bool hasMesh = presenter_.hasMesh();
    const bool isBusy = hasMesh && !comparison && presenter_.complaint().isEmpty();
    remove_->setEnabled(hasMesh);
    busy_->setVisible(isBusy);
    result_->setVisible(comparison != nullptr);
    drop_->setVisible(!hasMesh);
    const Theme theme = Theme::current();
    drop_->setStyleSheet(QStringLiteral("color: %1; border: 2px dashed %2; border-radius: 8px;")
                             .arg(theme.muted.name(), theme.line.name()));
    QColor colour = theme.text;
    if (!hasMesh) {
        verdict_->setText(tr("No mesh yet"));
        reason_->setText(
            tr("With a surface of the body, such as its drawing, you see how far each module lies above or "
               "below it. The two are laid on each other by themselves, wherever they are."));
    } else if (isBusy) {
        verdict_->setText(tr("Comparing with %1 …").arg(presenter_.name()));
        reason_->setText(tr("The body is tried on the mesh in many poses."));
    } else if (!comparison) {
        verdict_->setText(tr("Not compared"));
        reason_->setText(presenter_.complaint());
        colour = theme.bad;
    } else {
        const bool isDoubtful = !comparison->doubts.empty();
        verdict_->setText(
            isDoubtful ? tr("%1 rms from %2, with reservations").arg(MeshWords::mm(comparison->rms), presenter_.name())
                       : tr("%1 rms from %2").arg(MeshWords::mm(comparison->rms), presenter_.name()));
        colour = isDoubtful ? theme.attention : theme.good;
        const QString unit = presenter_.usedUnit() == MeshUnit::Millimetre ? tr("millimetres") : tr("metres");
        reason_->setText(presenter_.isStale()
                             ? tr("Stale: of before the last change. The newest body is being compared …")
                             : tr("The mesh is taken to be in %1. Deviations are along its outward normal, positive "
                                  "above.")
                                   .arg(unit));
    }
    verdict_->setStyleSheet(QStringLiteral("color: %1").arg(colour.name()));
    if (comparison != shown_)
        showComparison();
}

void MeshPanel::showComparison() {
    shown_ = presenter_.comparison();
    figures_->setRowCount(0);
    modules_->setRowCount(0);
    doubts_->clear();
    if (!shown_)
        return;
    for (const auto& [name, figure] : MeshWords::figuresOf(*shown_)) {
        const int row = figures_->rowCount();
        figures_->insertRow(row);
        figures_->setItem(row, 0, new QTableWidgetItem(name));
        figures_->setItem(row, 1, new QTableWidgetItem(figure));
    }
    std::vector<ModuleDeviation> sorted = shown_->modules;
    std::stable_sort(sorted.begin(), sorted.end(), [](const ModuleDeviation& a, const ModuleDeviation& b) {
        return std::abs(a.deviation) > std::abs(b.deviation);
    });
    modules_->setRowCount(static_cast<int>(sorted.size()));
    for (int row = 0; row < modules_->rowCount(); ++row) {
        const ModuleDeviation& module = sorted[static_cast<std::size_t>(row)];
        modules_->setItem(row, kModule, numberItem(QString::number(module.id.value)));
        modules_->setItem(row, kDeviation, numberItem(MeshWords::signedMm(module.deviation)));
        modules_->setItem(row, kAngle, numberItem(MeshWords::degrees(module.angle)));
    }
    for (const AlignmentDoubt& doubt : shown_->doubts)
        doubts_->addItem(MeshPresenter::sentenceOf(doubt));
    if (shown_->doubts.empty())
        doubts_->addItem(tr("No other pose fits as well, and every module has the mesh under it."));
}

}  // namespace skincal
