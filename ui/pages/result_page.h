#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/mesh_presenter.h"

class QTabWidget;
class QTableWidget;
class QListWidget;

namespace skincal {

class PicturePanel;

/// Whether to believe the body: its figures and what to know about them, the body on the pictures it came from, and
/// against a mesh of what it is mounted on.
class ResultPage : public Page {
    Q_OBJECT
  public:
    ResultPage(Workbench& workbench, MeshPresenter& mesh, QWidget* parent = nullptr);

    void setActive(bool active) override;
    /// The part of the page about the mesh, for who drops one on the window.
    void showMesh();
    /// Marks a module on the picture, too.
    void setSelected(std::optional<ModuleId> module);

    /// Rows of the quality table, for tests and reports: what, and its figure.
    [[nodiscard]] static std::vector<std::pair<QString, QString>> figuresOf(const Solution& solution);

  protected:
    void changeEvent(QEvent* event) override;

  signals:
    void moduleSelected(skincal::ModuleId module);

  private:
    [[nodiscard]] QWidget* buildQuality();
    void refresh();

    Workbench& workbench_;
    MeshPresenter& mesh_;
    QTabWidget* tabs_;
    PicturePanel* pictures_;
    QWidget* meshPanel_ = nullptr;
    QLabel* verdict_;
    QLabel* reason_;
    QTableWidget* figures_;
    QListWidget* reasons_;
};

}  // namespace skincal
