// What the window is made of.

#include <QAction>
#include <QComboBox>
#include <QListView>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
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
#include "ui/widgets/theme.h"
#include "ui/window/body_panel.h"
#include "ui/window/file_actions.h"
#include "ui/window/main_window.h"
#include "ui/window/problem_list.h"
#include "ui/window/step_delegate.h"

namespace skincal {
namespace {

/// No page makes the window larger than its screen.
QWidget* scrolled(QWidget* page) {
    auto* area = new QScrollArea;
    area->setWidget(page);
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setFocusPolicy(Qt::NoFocus);
    return area;
}

}  // namespace

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
            stack_->addWidget(scrolled(page));
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
    connect(&export_, &ExportPresenter::failed, this,
            [this](const QString& why) { problems_.setNotice(why, Step::Export); });
    connect(&export_, &ExportPresenter::written, this,
            [this](const QString&, const std::shared_ptr<const Solution>& of) {
                problems_.clearNotice();
                steps_.noteExport(of);
            });
}

QWidget* MainWindow::buildSteps() {
    stepList_ = new QListView;
    stepList_->setObjectName(QStringLiteral("steps"));
    stepList_->setAccessibleName(tr("Steps"));
    stepList_->setToolTip(
        tr("The steps and how far each is; any can be gone back to. Ctrl and a digit leads to one, F6 to the next part "
           "of the window."));
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
        // What another step marked in 3D means nothing here.
        showModules({});
        pages_.at(row)->setActive(true);
        refresh();
        // Who goes through the list with the arrow keys stays there.
        if (focusWidget() != stepList_)
            focusPage();
    });
    return stepList_;
}

QWidget* MainWindow::buildNavigation() {
    auto* bar = new QWidget;
    auto* row = new QHBoxLayout(bar);
    row->setContentsMargins(20, 4, 20, 12);
    back_ = new QPushButton(tr("Back"));
    back_->setToolTip(tr("To the step before (Alt+Left)"));
    next_ = new QPushButton(tr("Next"));
    next_->setObjectName(QStringLiteral("next"));
    next_->setToolTip(tr("To the next step (Alt+Right)"));
    row->addWidget(back_);
    row->addStretch();
    row->addWidget(next_);
    connect(back_, &QPushButton::clicked, this, [this] { showStep(kSteps.at(static_cast<std::size_t>(step()) - 1)); });
    connect(next_, &QPushButton::clicked, this, [this] {
        if (const auto after = stepAfter())
            showStep(*after);
    });
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
    const auto tellStale = [this, panel] { panel->setStale(workbench_.session().isStale()); };
    connect(&workbench_.session(), &Session::solvingChanged, panel, tellStale);
    connect(&workbench_.session(), &Session::solutionChanged, panel, tellStale);
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

    auto* problems = new ProblemList(problems_);
    connect(problems, &ProblemList::chosen, this, &MainWindow::jumpTo);

    auto* down = new QSplitter(Qt::Vertical);
    down->addWidget(across);
    down->addWidget(problems);
    down->setStretchFactor(0, 1);
    down->setSizes({760, 64});  // two lines: few skins have more to tell, and others scroll
    down->setCollapsible(0, false);
    setCentralWidget(down);

    busy_ = new QProgressBar;
    busy_->setRange(0, 0);
    busy_->setMaximumWidth(120);
    busy_->setVisible(false);
    // No higher than the bar is without it: what is above must not move.
    busy_->setMaximumHeight(statusBar()->sizeHint().height() - 6);
    busy_->setAccessibleName(tr("Solving"));
    busy_->setToolTip(tr("The body is being computed from the newest data; you can go on meanwhile"));
    statusBar()->addPermanentWidget(busy_);
}

void MainWindow::buildToolBar() {
    QToolBar* bar = addToolBar(tr("Tools"));
    bar->setMovable(false);
    bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
    files_.addTo(*bar);
    bar->addSeparator();
    QUndoStack& undo = workbench_.session().undoStack();
    const auto add = [&](const char* name, QKeySequence::StandardKey key, const QString& word, const QString& why,
                         auto work, auto canWork, auto described) {
        QAction* action = bar->addAction(word);
        action->setToolTip(why);
        action->setObjectName(QLatin1String(name));
        QList<QKeySequence> keys = QKeySequence::keyBindings(key);
        // Both are in people's fingers, whatever the desktop.
        if (key == QKeySequence::Redo && !keys.contains(QKeySequence(Qt::CTRL | Qt::Key_Y)))
            keys << QKeySequence(Qt::CTRL | Qt::Key_Y);
        action->setShortcuts(keys);
        action->setEnabled(false);  // a window begins with a session in which nothing was decided
        connect(action, &QAction::triggered, &undo, work);
        connect(&undo, canWork, action, &QAction::setEnabled);
        connect(&undo, described, action, [action, word](const QString& what) {
            action->setText(what.isEmpty() ? word : tr("%1: %2").arg(word, what));
        });
    };
    add("undo", QKeySequence::Undo, tr("Undo"),
        tr("Take back the last decision, whatever step it was made in; what was measured stays (Ctrl+Z)"),
        &QUndoStack::undo, &QUndoStack::canUndoChanged, &QUndoStack::undoTextChanged);
    add("redo", QKeySequence::Redo, tr("Redo"), tr("Make the decision again that was taken back (Ctrl+Shift+Z)"),
        &QUndoStack::redo, &QUndoStack::canRedoChanged, &QUndoStack::redoTextChanged);
    auto* space = new QWidget;
    space->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    bar->addWidget(space);
    theme_ = bar->addAction(QString());
    theme_->setObjectName(QStringLiteral("theme"));
    theme_->setShortcut(QKeySequence(Qt::CTRL | Qt::Key_T));
    connect(theme_, &QAction::triggered, this, [this] { setDark(!Theme::current().isDark); });
}

}  // namespace skincal
