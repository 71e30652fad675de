#include "ui/pages/pose_page.h"

#include <QCheckBox>
#include <QHeaderView>
#include <QKeySequence>
#include <QProgressBar>
#include <QPushButton>
#include <QShortcut>
#include <QTableView>

#include "ui/widgets/curve_plot.h"
#include "ui/widgets/gravity_sphere.h"
#include "ui/widgets/primary_button.h"

namespace skincal {
namespace {

using Phase = PoseCapture::Phase;

constexpr int kInspected = 5;  // worst modules of a pose that are named

}  // namespace

PosePage::PosePage(PosePresenter& presenter, QWidget* parent)
    : Page(
          tr("Pose the body"),
          tr("Turn the body to poses that differ as much as possible and hold it still in each. From how gravity looks "
             "to every module the shape of each patch follows."),
          parent),
      presenter_(presenter),
      sphere_(new GravitySphere),
      forecast_(new CurvePlot),
      instruction_(new QLabel),
      verdict_(new QLabel),
      movement_(mutedLabel()),
      rest_(new QProgressBar),
      capture_(new QPushButton(tr("Capture (space)"))),
      turn_(new QPushButton(tr("Turn the arm there"))),
      drop_(new QPushButton(tr("Drop pose"))),
      automatic_(new QCheckBox(tr("Capture by itself when the body rests"))),
      poses_(new QTableView),
      inspected_(mutedLabel()) {
    instruction_->setObjectName(QStringLiteral("instruction"));
    instruction_->setWordWrap(true);
    keepTwoLines(*instruction_);
    body().addWidget(instruction_);
    verdict_->setObjectName(QStringLiteral("poseVerdict"));
    verdict_->setWordWrap(true);
    body().addWidget(verdict_);
    auto* middle = new QHBoxLayout;
    middle->addWidget(sphere_, 3);
    auto* side = new QVBoxLayout;
    rest_->setRange(0, 100);
    rest_->setAccessibleName(tr("Stillness"));
    rest_->setFormat(tr("Held still: %p %"));
    rest_->setToolTip(tr("Fills while the body rests; then its pose is captured"));
    side->addWidget(rest_);
    side->addWidget(movement_);
    automatic_->setObjectName(QStringLiteral("automatic"));
    automatic_->setChecked(presenter.isAutomatic());
    automatic_->setToolTip(tr("Otherwise only the button and the space bar capture"));
    side->addWidget(automatic_);
    auto* buttons = new QHBoxLayout;
    capture_->setObjectName(QStringLiteral("capture"));
    capture_->setToolTip(tr("Capture this pose now, even if it is like another"));
    buttons->addWidget(capture_);
    turn_->setObjectName(QStringLiteral("turn"));
    turn_->setToolTip(tr("The simulated arm turns until the dot lies in the ring"));
    buttons->addWidget(turn_);
    buttons->addStretch();
    side->addLayout(buttons);
    forecast_->setTitle(tr("Expected error of an edge"));
    forecast_->setAbscissa(tr("poses"));
    forecast_->setUnit(tr("°"));
    forecast_->setObjectName(QStringLiteral("forecast"));
    constexpr double kGood_deg = PosePresenter::kGoodEdge / kDegree;
    forecast_->setGoal(kGood_deg, tr("good: below %1°").arg(kGood_deg));
    forecast_->setToolTip(
        tr("Standard deviation of the angle between two neighbours, from gravity alone, about the axis "
           "known worst. The dashed line is good."));
    side->addWidget(forecast_, 1);
    middle->addLayout(side, 4);
    body().addLayout(middle, 3);

    poses_->setModel(&presenter.poses());
    poses_->setAccessibleName(tr("Captured poses"));
    poses_->setObjectName(QStringLiteral("poses"));
    poses_->setToolTip(tr(
        "What each pose adds and how well it agrees with the others: select one to see the modules that disagree, and "
        "to drop it"));
    poses_->setSelectionBehavior(QAbstractItemView::SelectRows);
    poses_->setSelectionMode(QAbstractItemView::SingleSelection);
    poses_->verticalHeader()->hide();
    poses_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
    body().addWidget(poses_, 2);
    auto* below = new QHBoxLayout;
    below->addWidget(inspected_, 1);
    drop_->setObjectName(QStringLiteral("dropPose"));
    drop_->setToolTip(tr("The selected pose no longer counts; undo brings it back"));
    below->addWidget(drop_);
    body().addLayout(below);

    auto* space = new QShortcut(QKeySequence(Qt::Key_Space), this);
    connect(space, &QShortcut::activated, &presenter, &PosePresenter::captureNow);
    connect(capture_, &QPushButton::clicked, &presenter, &PosePresenter::captureNow);
    connect(turn_, &QPushButton::clicked, &presenter, &PosePresenter::turnToTarget);
    connect(automatic_, &QCheckBox::toggled, &presenter, &PosePresenter::setAutomatic);
    connect(drop_, &QPushButton::clicked, this, [this] {
        if (const int row = selectedRow(); row >= 0)
            presenter_.poses().setDropped(row, !presenter_.poses().isDropped(row));
    });
    connect(&presenter, &PosePresenter::sampled, this, &PosePage::showLive);
    connect(&presenter, &PosePresenter::stateChanged, this, &PosePage::refresh);
    connect(&presenter, &PosePresenter::refused, this,
            [this] { instruction_->setText(tr("The body moves: hold it still to capture.")); });
    connect(poses_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &PosePage::inspectSelected);
    connect(&presenter.poses(), &QAbstractItemModel::dataChanged, this, &PosePage::inspectSelected);
    // Another pose fills the table anew: the selection goes with the pose.
    connect(&presenter.poses(), &QAbstractItemModel::modelAboutToBeReset, this, [this] {
        const int row = selectedRow();
        kept_ = row < 0 ? std::nullopt : std::optional(presenter_.poses().poseAt(row));
    });
    connect(&presenter.poses(), &QAbstractItemModel::modelReset, this, [this] {
        if (const auto pose = std::exchange(kept_, std::nullopt))
            selectPose(*pose);
        inspectSelected();
    });
    refresh();
    inspectSelected();
}

void PosePage::setActive(bool active) {
    isActive_ = active;
    presenter_.setActive(active);
    refresh();
    // Its marks in 3D mean nothing to other pages.
    active ? inspectSelected() : showInBody({});
}

QWidget* PosePage::mainControl() const {
    return capture_;
}

void PosePage::showInBody(std::vector<ModuleId> modules) {
    if (modules == inBody_)
        return;
    inBody_ = std::move(modules);
    emit modulesSelected(inBody_);
}

void PosePage::selectPose(int pose) {
    for (int row = 0; row < presenter_.poses().rowCount(); ++row) {
        if (presenter_.poses().poseAt(row) == pose)
            poses_->selectRow(row);
    }
}

int PosePage::selectedRow() const {
    const QModelIndexList rows = poses_->selectionModel()->selectedRows();
    return rows.isEmpty() ? -1 : rows.first().row();
}

void PosePage::showLive() {
    sphere_->setCurrent(presenter_.up());
    const auto movement = presenter_.movement();
    rest_->setValue(static_cast<int>(100 * presenter_.restDone()));
    movement_->setText(
        movement
            ? tr("Movement %1 m/s² (still below %2)").arg(*movement, 0, 'f', 2).arg(presenter_.restsBelow(), 0, 'f', 2)
            : tr("Measuring …"));
    if (const auto angle = presenter_.angleToTarget(); angle && presenter_.state().phase == Phase::Captured)
        instruction_->setText((presenter_.verdict() == PoseVerdict::Enough
                                   ? tr("Captured. The next best pose is the ring, %1° away.")
                                   : tr("Captured. Turn the body by %1°, until the dot lies in the ring."))
                                  .arg(*angle / kDegree, 0, 'f', 0));
}

void PosePage::refresh() {
    sphere_->setCovered(presenter_.covered());
    sphere_->setTarget(presenter_.target());
    sphere_->setCurrent(presenter_.up());
    std::vector<std::optional<double>> degrees;
    for (const auto& sigma : presenter_.forecast())
        degrees.push_back(sigma ? std::optional(*sigma / kDegree) : std::nullopt);
    forecast_->setValues(std::move(degrees));
    const bool isEnough = presenter_.verdict() == PoseVerdict::Enough;
    const QString verdict = presenter_.verdictText();
    verdict_->setText(isEnough ? tr("✓ %1").arg(verdict) : verdict);
    verdict_->setProperty(isEnough ? "good" : "attention", !verdict.isEmpty());
    verdict_->setProperty(isEnough ? "attention" : "good", false);
    verdict_->style()->unpolish(verdict_);
    verdict_->style()->polish(verdict_);
    turn_->setVisible(presenter_.hasHands());
    setPrimary(turn_, !isEnough);
    const bool hasTarget = presenter_.target().has_value();
    switch (presenter_.state().phase) {
        case Phase::Off:
            instruction_->setText(tr("Connect the skin to see which way is up."));
            break;
        case Phase::Moving:
            instruction_->setText(hasTarget ? tr("Bring the dot into the ring, then hold the body still.")
                                            : tr("Hold the body still for the first pose."));
            break;
        case Phase::Resting:
            instruction_->setText(tr("Hold it …"));
            break;
        case Phase::Captured:
            break;
    }
    capture_->setEnabled(presenter_.state().phase != Phase::Off);
    turn_->setEnabled(presenter_.state().phase != Phase::Off && hasTarget);
}

void PosePage::inspectSelected() {
    const int row = selectedRow();
    drop_->setEnabled(row >= 0);
    drop_->setText(row >= 0 && presenter_.poses().isDropped(row) ? tr("Take pose back") : tr("Drop pose"));
    std::vector<ModuleId> modules;
    if (row < 0) {
        inspected_->setText(tr("Select a pose to see which modules disagree with their patch."));
    } else if (const auto residuals = presenter_.poses().residualsOf(presenter_.poses().poseAt(row));
               residuals.empty()) {
        inspected_->setText(tr("No residuals yet: patches have no shape."));
    } else {
        QStringList worst;
        for (std::size_t i = 0; i < residuals.size() && i < kInspected; ++i) {
            worst << tr("module %1: %2 m/s²").arg(residuals[i].module.value).arg(residuals[i].length, 0, 'f', 3);
            modules.push_back(residuals[i].module);
        }
        inspected_->setText(tr("Farthest from their patch: %1").arg(worst.join(QStringLiteral(", "))));
    }
    if (isActive_)
        showInBody(std::move(modules));
}

}  // namespace skincal
