#pragma once

#include <QWidget>

#include "ui/presenters/mesh_presenter.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QListWidget;
class QProgressBar;
class QPushButton;
class QTableWidget;

namespace skincal {

/// The body against a mesh of what it is mounted on: the file, how well the two agree, what to doubt, and the modules
/// that stand out. The 3D view shows the mesh and the deviations meanwhile.
class MeshPanel : public QWidget {
    Q_OBJECT
  public:
    explicit MeshPanel(MeshPresenter& presenter, QWidget* parent = nullptr);

  signals:
    void moduleSelected(skincal::ModuleId module);

  protected:
    void changeEvent(QEvent* event) override;

  private:
    void refresh();
    void showComparison();
    void choose();

    MeshPresenter& presenter_;
    QPushButton* open_;
    QPushButton* simulated_;
    QPushButton* remove_;
    QComboBox* unit_;
    QCheckBox* offset_;
    QLabel* verdict_;
    QLabel* reason_;
    QProgressBar* busy_;
    QLabel* drop_;
    QWidget* result_;
    QTableWidget* figures_;
    QTableWidget* modules_;
    QListWidget* doubts_;
    std::shared_ptr<const MeshComparison> shown_;
};

}  // namespace skincal
