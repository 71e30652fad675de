#include "ui/pages/result_page.h"

#include <QEvent>
#include <QHeaderView>
#include <QListWidget>
#include <QTabWidget>
#include <QTableWidget>
#include <algorithm>
#include <cmath>

#include "ui/pages/mesh_panel.h"
#include "ui/pages/picture_panel.h"
#include "ui/texts/sentences.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

/// Standard deviations of the positions of placed modules, m, rising.
std::vector<double> positionSigmas(const BodyModel& body) {
    std::vector<double> sigmas;
    for (const BodyModule& module : body.modules) {
        if (module.T_body_module && module.covariance)
            sigmas.push_back(std::sqrt(module.covariance->bottomRightCorner<3, 3>().trace() / 3));
    }
    std::sort(sigmas.begin(), sigmas.end());
    return sigmas;
}

}  // namespace

ResultPage::ResultPage(Workbench& workbench, MeshPresenter& mesh, QWidget* parent)
    : Page(tr("Result"), tr("Every placed module, how well it is known, and whether to believe it."), parent),
      workbench_(workbench),
      mesh_(mesh),
      tabs_(new QTabWidget),
      pictures_(new PicturePanel(workbench)),
      verdict_(new QLabel),
      reason_(mutedLabel()),
      figures_(new QTableWidget),
      reasons_(new QListWidget) {
    verdict_->setObjectName(QStringLiteral("instruction"));
    body().addWidget(verdict_);
    body().addWidget(reason_);
    auto* panel = new MeshPanel(mesh);
    meshPanel_ = panel;
    tabs_->setObjectName(QStringLiteral("resultTabs"));
    tabs_->setAccessibleName(tr("What to look at"));
    tabs_->setToolTip(tr("Ways to judge the body: by its figures, on the pictures, against a surface"));
    const auto add = [&](QWidget* widget, const QString& name, const QString& what) {
        tabs_->setTabToolTip(tabs_->addTab(widget, name), what);
    };
    add(buildQuality(), tr("Quality"), tr("The figures, and what to know about them"));
    add(pictures_, tr("On the pictures"), tr("The body drawn on the picture of a view"));
    add(panel, tr("Against a mesh"), tr("How far the modules lie above a surface of the body"));
    body().addWidget(tabs_, 1);
    connect(pictures_, &PicturePanel::moduleSelected, this, &ResultPage::moduleSelected);
    connect(panel, &MeshPanel::moduleSelected, this, &ResultPage::moduleSelected);
    connect(&workbench.session(), &Session::solutionChanged, this, &ResultPage::refresh);
    connect(&workbench.session(), &Session::solvingChanged, this, &ResultPage::refresh);
    refresh();
}

void ResultPage::setActive(bool active) {
    pictures_->setActive(active);
    mesh_.setActive(active);
}

void ResultPage::changeEvent(QEvent* event) {
    // The verdict's colour is one of the theme's.
    if (event->type() == QEvent::PaletteChange)
        refresh();
    Page::changeEvent(event);
}

void ResultPage::showMesh() {
    tabs_->setCurrentWidget(meshPanel_);
}

void ResultPage::setSelected(std::optional<ModuleId> module) {
    pictures_->setSelected(module);
}

QWidget* ResultPage::buildQuality() {
    auto* quality = new QWidget;
    auto* column = new QVBoxLayout(quality);
    column->setContentsMargins(12, 12, 12, 12);
    column->setSpacing(8);
    figures_->setColumnCount(2);
    figures_->setObjectName(QStringLiteral("figures"));
    figures_->setAccessibleName(tr("Quality"));
    figures_->horizontalHeader()->hide();
    figures_->verticalHeader()->hide();
    figures_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    figures_->horizontalHeader()->setStretchLastSection(true);
    figures_->setEditTriggers(QAbstractItemView::NoEditTriggers);
    figures_->setSelectionMode(QAbstractItemView::NoSelection);
    figures_->verticalHeader()->setDefaultSectionSize(figures_->fontMetrics().height() + 8);
    figures_->setToolTip(tr("σ is a standard deviation; that of a position is per axis"));
    column->addWidget(figures_, 3);
    column->addWidget(mutedLabel(tr("What to know about it:")));
    reasons_->setWordWrap(true);
    reasons_->setObjectName(QStringLiteral("reasons"));
    reasons_->setAccessibleName(tr("Reasons for the verdict"));
    reasons_->setToolTip(tr("What is missing or disagrees, and so keeps the body from being better"));
    column->addWidget(reasons_, 1);
    return quality;
}

std::vector<std::pair<QString, QString>> ResultPage::figuresOf(const Solution& solution) {
    const BodyModel& body = solution.body;
    const BodyQuality& quality = body.quality;
    std::vector<std::pair<QString, QString>> rows;
    rows.emplace_back(tr("Modules placed"), tr("%1 of %2").arg(quality.modulesPlaced).arg(quality.modulesTotal));
    const auto placedPatches = std::count_if(body.patches.begin(), body.patches.end(),
                                             [](const BodyPatch& patch) { return patch.T_body_patch.has_value(); });
    rows.emplace_back(tr("Patches placed"), tr("%1 of %2").arg(placedPatches).arg(body.patches.size()));
    const auto placedViews = std::count_if(body.views.begin(), body.views.end(),
                                           [](const BodyView& view) { return view.T_body_camera.has_value(); });
    rows.emplace_back(tr("Views used"), tr("%1 of %2").arg(placedViews).arg(body.views.size()));
    const auto unseen = std::count_if(body.modules.begin(), body.modules.end(),
                                      [](const BodyModule& module) { return module.T_body_module && !module.seen; });
    rows.emplace_back(tr("Placed by gravity and links alone"), QString::number(unseen));
    if (const auto sigmas = positionSigmas(body); !sigmas.empty()) {
        rows.emplace_back(tr("Position relative to the first view, σ (median)"),
                          tr("%1 mm").arg(1e3 * sigmas[sigmas.size() / 2], 0, 'f', 2));
        rows.emplace_back(tr("Position relative to the first view, σ (worst)"),
                          tr("%1 mm").arg(1e3 * sigmas.back(), 0, 'f', 2));
    }
    const auto add = [&](const QString& name, const std::optional<double>& value, double factor, const QString& unit,
                         int digits) {
        if (value)
            rows.emplace_back(name, tr("%1 %2").arg(factor * *value, 0, 'f', digits).arg(unit));
    };
    add(tr("Reprojection error (rms)"), quality.residual_rms_px, 1, tr("px"), 3);
    add(tr("Ports of neighbours apart (rms)"), quality.link_mismatch_rms, 1e3, tr("mm"), 2);
    add(tr("Ports of neighbours apart (widest)"), quality.link_mismatch_max, 1e3, tr("mm"), 2);
    add(tr("Gravity residual (rms)"), quality.gravity_residual_rms, 1, tr("m/s²"), 3);
    rows.emplace_back(tr("Solved in"), tr("%1 s").arg(solution.seconds, 0, 'f', 2));
    return rows;
}

void ResultPage::refresh() {
    const auto& solution = workbench_.session().solution();
    figures_->setRowCount(0);
    reasons_->clear();
    if (!solution) {
        verdict_->setText(tr("No body yet"));
        verdict_->setStyleSheet({});  // that of the verdict before
        reason_->setText(tr("Capture poses and scan a view first."));
        return;
    }
    const Theme theme = Theme::current();
    const BodyQuality& quality = solution->body.quality;
    const bool isPlaced = quality.modulesPlaced > 0;
    verdict_->setText(isPlaced ? saidAlone(sentenceOf(quality.trust)) : tr("Shapes of patches, not placed yet"));
    const QColor colour = quality.trust == Trust::NotToBeTrusted ? theme.bad
                          : quality.trust == Trust::Usable       ? theme.attention
                                                                 : theme.good;
    verdict_->setStyleSheet(QStringLiteral("color: %1").arg((isPlaced ? colour : theme.text).name()));
    const Session& session = workbench_.session();
    const bool isStale = session.isStale();
    figures_->setEnabled(!isStale);
    reasons_->setEnabled(!isStale);
    reason_->setText(
        isStale && session.isSolving() ? tr("Stale: of before the last change. The newest data are being solved …")
        : isStale
            ? tr("Stale: of before the last change. The newest data give no body: %1").arg(said(session.failure()))
        : isPlaced ? tr("All figures are of the newest data. Colours and ellipsoids of the 3D view are chosen "
                        "above it.")
                   : tr("Scan a view to place them."));
    for (const auto& [name, figure] : figuresOf(*solution)) {
        const int row = figures_->rowCount();
        figures_->insertRow(row);
        figures_->setItem(row, 0, new QTableWidgetItem(name));
        figures_->setItem(row, 1, new QTableWidgetItem(figure));
    }
    for (const auto* texts : {&quality.warnings, &quality.missing}) {
        for (const Sentence& text : *texts)
            reasons_->addItem(saidAlone(text));
    }
    for (const Shortfall& shortfall : solution->shortfalls) {
        // The verdict may have named it.
        const QString text = saidAlone(shortfall.text);
        if (reasons_->findItems(text, Qt::MatchExactly).empty())
            reasons_->addItem(text);
    }
    if (reasons_->count() == 0)
        reasons_->addItem(tr("Nothing is missing, and nothing disagrees."));
}

}  // namespace skincal
