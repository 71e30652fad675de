#include "ui/window/main_window.h"

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QComboBox>
#include <QDir>
#include <QFileInfo>
#include <QListView>
#include <QLocale>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QScreen>
#include <QStackedWidget>
#include <QStatusBar>

#include "ui/pages/demo_page.h"
#include "ui/pages/pose_page.h"
#include "ui/pages/result_page.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/texts/sentences.h"
#include "ui/widgets/primary_button.h"
#include "ui/widgets/theme.h"
#include "ui/window/demo_stage.h"
#include "ui/window/file_actions.h"
#include "ui/window/mesh_stage.h"

namespace skincal {
namespace {

std::size_t indexOf(Step step) {
    return static_cast<std::size_t>(step);
}

bool isMesh(const QFileInfo& file) {
    return file.isFile() && file.suffix().compare(QStringLiteral("stl"), Qt::CaseInsensitive) == 0;
}

/// What can be opened of what is dragged here: a mesh, or the folder of a recording, which may be dragged by the file
/// that makes it one.
std::optional<QFileInfo> droppedFile(const QMimeData& dragged) {
    const auto urls = dragged.urls();
    if (urls.size() != 1 || !urls.first().isLocalFile())
        return std::nullopt;
    const QFileInfo file(urls.first().toLocalFile());
    const QString recording = QStringLiteral("recording.json");
    if (isMesh(file) || (file.isDir() && QFileInfo::exists(QDir(file.filePath()).filePath(recording))))
        return file;
    return file.isFile() && file.fileName() == recording ? std::optional(QFileInfo(file.path())) : std::nullopt;
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
    resize(QSize(1440, 900).boundedTo(screen()->availableSize()));
    buildPages();
    buildFrame();
    buildToolBar();
    buildKeys();
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
            [this](const Sentence& stage, double) { statusBar()->showMessage(tr("Solving: %1").arg(said(stage))); });
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
    setDark(Theme::current().isDark);
    showStep(Step::Connect);
    refresh();
}

MainWindow::~MainWindow() = default;

Step MainWindow::step() const {
    return kSteps.at(static_cast<std::size_t>(std::max(0, stepList_->currentIndex().row())));
}

void MainWindow::showStep(Step step) {
    stepList_->setCurrentIndex(steps_.index(static_cast<int>(indexOf(step))));
}

std::optional<Step> MainWindow::stepAfter() const {
    // Who scanned the last view that was needed need not be sent back to move the camera.
    if (step() == Step::Scan && steps_.states().at(indexOf(Step::Views)).status == StepStatus::Done)
        return Step::Result;
    const std::size_t row = indexOf(step()) + 1;
    return row < kSteps.size() ? std::optional(kSteps.at(row)) : std::nullopt;
}

void MainWindow::setDark(bool dark) {
    const Theme theme = dark ? Theme::dark() : Theme::light();
    // Without the old style sheet for a moment: changing one for another takes Qt five times as long as putting one on.
    qApp->setStyleSheet({});
    QApplication::setPalette(theme.palette());
    qApp->setStyleSheet(theme.styleSheet());
    body_->setDark(dark);
    // What a click gives.
    theme_->setText(dark ? tr("Light colours") : tr("Dark colours"));
    theme_->setToolTip(dark ? tr("Change to light colours (Ctrl+T)") : tr("Change to dark colours (Ctrl+T)"));
}

void MainWindow::begin(const RigOffers& offers) {
    workbench_.chooseCamera(offers.camera);
    connection_.chooseDevice(static_cast<int>(offers.skin));
    connection_.connectSkin();
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
    body_->setGuideCamera(step() == Step::Views ? views_.target() : std::nullopt);
    const std::size_t row = indexOf(step());
    back_->setVisible(row > 0);
    if (row > 0)
        back_->setText(tr("‹ %1").arg(nameOf(kSteps.at(row - 1))));
    const auto after = stepAfter();
    next_->setVisible(after.has_value());
    if (after) {
        next_->setText(tr("%1 ›").arg(nameOf(*after)));
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
    if (droppedFile(*event->mimeData()))
        event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
    const auto file = droppedFile(*event->mimeData());
    if (!file)
        return;
    event->acceptProposedAction();
    isMesh(*file) ? openMesh(file->filePath()) : openRecording(file->filePath());
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
