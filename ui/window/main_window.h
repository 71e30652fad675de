#pragma once

#include <QMainWindow>
#include <array>
#include <memory>

#include "core/session/session_keeper.h"
#include "ui/presenters/demo_presenter.h"
#include "ui/presenters/export_presenter.h"
#include "ui/presenters/mesh_presenter.h"
#include "ui/presenters/pose_presenter.h"
#include "ui/presenters/problem_model.h"
#include "ui/presenters/step_model.h"
#include "ui/presenters/view_preview.h"
#include "ui/window/rig_offers.h"

class QAction;
class QComboBox;
class QListView;
class QProgressBar;
class QPushButton;
class QStackedWidget;

namespace skincal {

class BodyViewWidget;
class FileActions;
class Page;
class ResultPage;

/// The window: steps on the left, the page in the middle, the body on the right, what is wrong below.
class MainWindow : public QMainWindow {
    Q_OBJECT
  public:
    /// @param workbench  with its offers; must outlive the window.
    explicit MainWindow(Workbench& workbench, QWidget* parent = nullptr);
    ~MainWindow() override;

    void showStep(Step step);
    [[nodiscard]] Step step() const;
    void setDark(bool dark);
    /// Chooses these devices, and connects the skin at once.
    void begin(const RigOffers& offers);
    /// A recording from a file; a complaint becomes a problem.
    void openRecording(const QString& directory);
    /// Offers what an earlier run left unsaved, the newest of it.
    void offerKept(const SessionKeeper& keeper);

    [[nodiscard]] FileActions& files() { return files_; }
    [[nodiscard]] BodyViewWidget& bodyView() { return *body_; }
    [[nodiscard]] StepModel& steps() { return steps_; }
    [[nodiscard]] ProblemModel& problems() { return problems_; }

  protected:
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;
    void closeEvent(QCloseEvent* event) override;

  private:
    void buildPages();
    void buildToolBar();
    void buildFrame();
    void buildKeys();
    /// Gives the keys to what comes first on the page.
    void focusPage();
    /// To the next of steps, page, body and problems, or with -1 the one before.
    void focusArea(int way);
    [[nodiscard]] QWidget* buildSteps();
    [[nodiscard]] QWidget* buildNavigation();
    void offerNewest(const SessionKeeper& keeper);
    /// The step that the button leads on to; nothing after the last.
    [[nodiscard]] std::optional<Step> stepAfter() const;
    void showBody();
    void refresh();
    void jumpTo(int problem);
    void showModules(const std::vector<ModuleId>& modules);
    void openMesh(const QString& file);

    Workbench& workbench_;
    ConnectPresenter connection_;
    PosePresenter pose_;
    ScanPresenter scan_;
    ViewsPresenter views_;
    ViewPreview preview_;
    ExportPresenter export_;
    DemoPresenter demo_;
    MeshPresenter mesh_;
    StepModel steps_;
    ProblemModel problems_;
    FileActions& files_;

    QListView* stepList_ = nullptr;
    QStackedWidget* stack_ = nullptr;
    std::array<Page*, kSteps.size()> pages_{};
    ResultPage* result_ = nullptr;
    BodyViewWidget* body_ = nullptr;
    QComboBox* colours_ = nullptr;
    QPushButton* back_ = nullptr;
    QPushButton* next_ = nullptr;
    QProgressBar* busy_ = nullptr;
    QAction* theme_ = nullptr;         ///< changes to the other
    std::optional<KeptSession> kept_;  ///< that was offered
};

}  // namespace skincal
