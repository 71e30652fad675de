#include "ui/window/main_window.h"

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QComboBox>
#include <QListView>
#include <QLocale>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QSplitter>
#include <QStackedWidget>
#include <QStatusBar>
#include <QToolBar>
#include <QVBoxLayout>

#include "ui/pages/camera_page.h"
#include "ui/pages/connect_page.h"
#include "ui/pages/demo_page.h"
#include "ui/pages/export_page.h"
#include "ui/pages/pose_page.h"
#include "ui/pages/result_page.h"
#include "ui/pages/scan_page.h"
#include "ui/pages/views_page.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/widgets/primary_button.h"
#include "ui/widgets/theme.h"
#include "ui/window/body_panel.h"
#include "ui/window/demo_stage.h"
#include "ui/window/file_actions.h"
#include "ui/window/mesh_stage.h"
#include "ui/window/step_delegate.h"

namespace skincal {
namespace {

std::size_t indexOf(Step step) {
    return static_cast<std::size_t>(step);
}

}  // namespace

MainWindow::MainWindow(Workbench& workbench, QWidget* parent)
    : QMainWindow(parent),
      workbench_(workbench),
      connection_(workbench),
      pose_(workbench),
      scan_(workbench),
      views_(workbench),
      preview_(workbench, scan_, views_),
      export_(workbench),
      demo_(workbench),
      mesh_(workbench),
      steps_(workbench, connection_, scan_),
      problems_(workbench, connection_, scan_),
      files_(*new FileActions(workbench.session(), *this)) {
    setWindowTitle(tr("SkinCal[*]"));
    setAcceptDrops(true);
    resize(1440, 900);
    buildPages();
    buildFrame();
    buildToolBar();
    auto* demo = new DemoStage(demo_, *static_cast<DemoPage*>(pages_.at(indexOf(Step::Demo))), *body_, this);
    connect(demo, &DemoStage::activeChanged, colours_, &QWidget::setDisabled);
    new MeshStage(mesh_, *body_, *colours_, this);

    Session& session = workbench_.session();
    connect(&session, &Session::solutionChanged, this, &MainWindow::showBody);
    connect(&session, &Session::guidanceChanged, this, &MainWindow::refresh);
    connect(&session, &Session::solvingChanged, this, [this](bool solving) {
        busy_->setVisible(solving);
        if (!solving)
            statusBar()->clearMessage();
    });
    connect(&session, &Session::solvingProgressed, this,
            [this](const QString& stage, double) { statusBar()->showMessage(tr("Solving: %1").arg(stage)); });
    connect(&session, &Session::modifiedChanged, this, &QWidget::setWindowModified);
    connect(&session, &Session::fileFailed, this, [this](const QString& why) {
        statusBar()->clearMessage();
        problems_.setNotice(why, Step::Connect);
    });
    connect(&files_, &FileActions::said, this, [this](const QString& text) { statusBar()->showMessage(text); });
    connect(&files_, &FileActions::complained, &problems_, &ProblemModel::setNotice);
    connect(&session, &Session::opened, this, [this](const QString& directory) {
        problems_.clearNotice();
        statusBar()->showMessage(tr("Opened %1").arg(directory));
        if (kept_ && kept_->directory == directory) {
            // It lies where it may go: it has no file of its own before it is saved.
            files_.setFile({});
            workbench_.session().setUnsaved();
            problems_.setKept({}, {});
        }
        showStep(steps_.next());
    });
    connect(&session, &Session::copied, this, [this] {
        if (kept_ && workbench_.session().isModified() && problems_.isOfferTaken())
            SessionKeeper::forget(*std::exchange(kept_, std::nullopt));
    });
    connect(&session, &Session::saved, this, [this](const QString& directory) {
        problems_.clearNotice();
        statusBar()->showMessage(tr("Saved %1").arg(directory));
    });
    connect(&steps_, &StepModel::changed, this, &MainWindow::refresh);
    connect(&problems_, &QAbstractItemModel::modelReset, this, &MainWindow::refresh);
    setDark(Theme::current().isDark);
    showStep(Step::Connect);
    refresh();
}

MainWindow::~MainWindow() = default;

void MainWindow::buildPages() {
    stack_ = new QStackedWidget;
    auto* connectPage = new ConnectPage(workbench_, connection_);
    auto* posePage = new PosePage(pose_);
    auto* cameraPage = new CameraPage(workbench_, scan_);
    auto* scanPage = new ScanPage(workbench_, scan_);
    auto* viewsPage = new ViewsPage(views_, scan_, preview_);
    result_ = new ResultPage(workbench_, mesh_);
    auto* exportPage = new ExportPage(export_);
    auto* demoPage = new DemoPage(demo_);
    pages_ = {connectPage, posePage, cameraPage, scanPage, viewsPage, result_, exportPage, demoPage};
    for (Page* page : pages_) {
        if (page != nullptr)
            stack_->addWidget(page);
    }
    connect(connectPage, &ConnectPage::moduleSelected, this, [this](ModuleId module) { showModules({module}); });
    connect(posePage, &PosePage::modulesSelected, this, &MainWindow::showModules);
    connect(scanPage, &ScanPage::moduleSelected, this, [this](ModuleId module) { showModules({module}); });
    connect(result_, &ResultPage::moduleSelected, this, [this](ModuleId module) { showModules({module}); });
    connect(viewsPage, &ViewsPage::scanAsked, this, [this] {
        showStep(Step::Scan);
        scan_.start();
    });
    connect(cameraPage, &CameraPage::failed, this,
            [this](const QString& why) { problems_.setNotice(why, Step::Camera); });
    connect(exportPage, &ExportPage::failed, this,
            [this](const QString& why) { problems_.setNotice(why, Step::Export); });
    connect(&export_, &ExportPresenter::written, this, [this] {
        problems_.clearNotice();
        steps_.noteExport();
    });
}

QWidget* MainWindow::buildSteps() {
    stepList_ = new QListView;
    stepList_->setObjectName(QStringLiteral("steps"));
    stepList_->setAccessibleName(tr("Steps"));
    stepList_->setModel(&steps_);
    stepList_->setItemDelegate(new StepDelegate(stepList_));
    stepList_->setFrameShape(QFrame::NoFrame);
    stepList_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    stepList_->setMinimumWidth(210);
    stepList_->setMaximumWidth(290);
    connect(stepList_->selectionModel(), &QItemSelectionModel::currentChanged, this, [this](const QModelIndex& to) {
        const auto row = static_cast<std::size_t>(to.row());
        for (std::size_t i = 0; i < pages_.size(); ++i) {
            if (pages_.at(i) != nullptr && i != row)
                pages_.at(i)->setActive(false);
        }
        if (pages_.at(row) == nullptr)
            return;
        stack_->setCurrentIndex(static_cast<int>(row));
        pages_.at(row)->setActive(true);
        refresh();
    });
    return stepList_;
}

QWidget* MainWindow::buildNavigation() {
    auto* bar = new QWidget;
    auto* row = new QHBoxLayout(bar);
    row->setContentsMargins(20, 4, 20, 12);
    back_ = new QPushButton;
    back_->setToolTip(tr("To the step before (Alt+Left)"));
    back_->setShortcut(QKeySequence(Qt::ALT | Qt::Key_Left));
    next_ = new QPushButton;
    next_->setObjectName(QStringLiteral("next"));
    next_->setToolTip(tr("To the next step (Alt+Right)"));
    next_->setShortcut(QKeySequence(Qt::ALT | Qt::Key_Right));
    row->addWidget(back_);
    row->addStretch();
    row->addWidget(next_);
    connect(back_, &QPushButton::clicked, this, [this] { showStep(kSteps.at(indexOf(step()) - 1)); });
    connect(next_, &QPushButton::clicked, this, [this] { showStep(kSteps.at(indexOf(step()) + 1)); });
    return bar;
}

void MainWindow::buildFrame() {
    auto* centre = new QWidget;
    auto* column = new QVBoxLayout(centre);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    column->addWidget(stack_, 1);
    column->addWidget(buildNavigation());

    auto* across = new QSplitter(Qt::Horizontal);
    across->addWidget(buildSteps());
    across->addWidget(centre);
    auto* panel = new BodyPanel;
    body_ = &panel->view();
    colours_ = &panel->colours();
    connect(&workbench_.session(), &Session::solvingChanged, panel,
            [this, panel](bool solving) { panel->setStale(solving && workbench_.session().solution() != nullptr); });
    connect(body_, &BodyViewWidget::moduleClicked, this, [this](ModuleId module) {
        showModules({module});
        connection_.blink(module);
    });
    across->addWidget(panel);
    across->setStretchFactor(0, 0);
    across->setStretchFactor(1, 5);
    across->setStretchFactor(2, 4);
    across->setSizes({230, 680, 530});
    across->setChildrenCollapsible(false);

    problemList_ = new QListView;
    problemList_->setObjectName(QStringLiteral("problems"));
    problemList_->setAccessibleName(tr("Problems"));
    problemList_->setModel(&problems_);
    problemList_->setItemDelegate(new ProblemDelegate(problemList_));
    problemList_->setFrameShape(QFrame::NoFrame);
    problemList_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    problemList_->setToolTip(tr("What is wrong or missing; activate one to go where it is mended"));
    connect(problemList_, &QListView::activated, this, [this](const QModelIndex& index) { jumpTo(index.row()); });
    connect(problemList_, &QListView::clicked, this, [this](const QModelIndex& index) { jumpTo(index.row()); });

    auto* down = new QSplitter(Qt::Vertical);
    down->addWidget(across);
    down->addWidget(problemList_);
    down->setStretchFactor(0, 1);
    down->setSizes({760, 96});
    down->setCollapsible(0, false);
    setCentralWidget(down);

    busy_ = new QProgressBar;
    busy_->setRange(0, 0);
    busy_->setMaximumWidth(120);
    busy_->setVisible(false);
    busy_->setAccessibleName(tr("Solving"));
    statusBar()->addPermanentWidget(busy_);
}

void MainWindow::buildToolBar() {
    QToolBar* bar = addToolBar(tr("Tools"));
    bar->setMovable(false);
    bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
    files_.addTo(*bar);
    bar->addSeparator();
    QUndoStack& undo = workbench_.session().undoStack();
    auto* undoAction = undo.createUndoAction(this, tr("Undo"));
    undoAction->setShortcut(QKeySequence::Undo);
    undoAction->setObjectName(QStringLiteral("undo"));
    auto* redoAction = undo.createRedoAction(this, tr("Redo"));
    redoAction->setShortcut(QKeySequence::Redo);
    redoAction->setObjectName(QStringLiteral("redo"));
    bar->addAction(undoAction);
    bar->addAction(redoAction);
    auto* space = new QWidget;
    space->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    bar->addWidget(space);
    dark_ = bar->addAction(tr("Dark"));
    dark_->setCheckable(true);
    dark_->setToolTip(tr("Dark or light colours"));
    connect(dark_, &QAction::toggled, this, &MainWindow::setDark);
}

Step MainWindow::step() const {
    return kSteps.at(static_cast<std::size_t>(std::max(0, stepList_->currentIndex().row())));
}

void MainWindow::showStep(Step step) {
    stepList_->setCurrentIndex(steps_.index(static_cast<int>(indexOf(step))));
}

void MainWindow::setDark(bool dark) {
    const Theme theme = dark ? Theme::dark() : Theme::light();
    QApplication::setPalette(theme.palette());
    qApp->setStyleSheet(theme.styleSheet());
    body_->setDark(dark);
    const QSignalBlocker blocker(dark_);
    dark_->setChecked(dark);
}

void MainWindow::openRecording(const QString& directory) {
    files_.open(directory);
}

void MainWindow::offerKept(const SessionKeeper& keeper) {
    connect(&keeper, &SessionKeeper::failed, this,
            [this](const QString& why) { problems_.setNotice(why, Step::Connect); });
    // What another recording has taken the place of can be had back at once.
    connect(
        &workbench_.session(), &Session::opened, &keeper, [this, &keeper] { offerNewest(keeper); },
        Qt::QueuedConnection);
    offerNewest(keeper);
}

void MainWindow::offerNewest(const SessionKeeper& keeper) {
    const auto sessions = keeper.kept();
    if (sessions.empty() || kept_)
        return;
    kept_ = sessions.front();
    problems_.setKept(kept_->directory, QLocale().toString(kept_->time, QLocale::ShortFormat));
}

void MainWindow::showBody() {
    const auto& solution = workbench_.session().solution();
    body_->setBody(solution ? std::shared_ptr<const BodyModel>(solution, &solution->body) : nullptr);
    refresh();
}

void MainWindow::showModules(const std::vector<ModuleId>& modules) {
    body_->setSelected(modules);
    result_->setSelected(modules.size() == 1 ? std::optional(modules.front()) : std::nullopt);
}

void MainWindow::openMesh(const QString& file) {
    showStep(Step::Result);
    result_->showMesh();
    mesh_.open(file);
}

void MainWindow::refresh() {
    problemList_->setVisible(problems_.rowCount() > 0);
    body_->setGuideCamera(step() == Step::Views ? views_.target() : std::nullopt);
    const std::size_t row = indexOf(step());
    back_->setVisible(row > 0);
    if (row > 0)
        back_->setText(tr("‹ %1").arg(nameOf(kSteps.at(row - 1))));
    const bool hasNext = row + 1 < kSteps.size();
    next_->setVisible(hasNext);
    if (hasNext) {
        next_->setText(tr("%1 ›").arg(nameOf(kSteps.at(row + 1))));
        const StepStatus status = steps_.states().at(row).status;
        setPrimary(next_, status == StepStatus::Done);
    }
}

void MainWindow::jumpTo(int row) {
    const Problem problem = problems_.problemAt(row);
    if (!problem.directory.isEmpty()) {
        openRecording(problem.directory);
        return;
    }
    showStep(problem.step);
    if (!problem.view.empty())
        scan_.showView(problem.view);
    if (problem.pose >= 0)
        static_cast<PosePage*>(pages_.at(indexOf(Step::Pose)))->selectPose(problem.pose);
    if (!problem.modules.empty())
        showModules(problem.modules);
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    if (event->mimeData()->hasUrls())
        event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
    const auto urls = event->mimeData()->urls();
    if (urls.isEmpty() || !urls.first().isLocalFile())
        return;
    const QString file = urls.first().toLocalFile();
    if (file.endsWith(QStringLiteral(".stl"), Qt::CaseInsensitive))
        openMesh(file);
    else
        openRecording(file);
}

void MainWindow::closeEvent(QCloseEvent* event) {
    for (Page* page : pages_) {
        if (page != nullptr)
            page->setActive(false);
    }
    scan_.cancel();
    QMainWindow::closeEvent(event);
}

}  // namespace skincal
