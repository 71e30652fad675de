#pragma once

#include <vtkSmartPointer.h>

#include <QFutureWatcher>
#include <QObject>

#include "ui/presenters/mesh_presenter.h"
#include "ui/scene3d/body_words.h"

class QComboBox;
class vtkPolyData;

namespace skincal {

class BodyViewWidget;

/// What the 3D view shows of a comparison with a mesh: the mesh about the body, and a choice of colours that is there
/// only as long as deviations are.
class MeshStage : public QObject {
    Q_OBJECT
  public:
    /// All three live as long as the window shows anything. They may be gone before this is, as a window's members and
    /// the children that it had before are: its end touches none of them.
    /// @param colours  its items' data are ColourModes
    MeshStage(MeshPresenter& presenter, BodyViewWidget& view, QComboBox& colours, QObject* parent);

    /// Waits for what is being made ready.
    ~MeshStage() override;

  private:
    void arrange();
    void offerDeviations(bool offered);

    MeshPresenter& presenter_;
    BodyViewWidget& view_;
    QComboBox& colours_;
    std::shared_ptr<const MeshComparison> shown_;
    std::shared_ptr<const MeshComparison> drawn_;  ///< of which the mesh is being made ready
    QFutureWatcher<vtkSmartPointer<vtkPolyData>> ready_;
    int before_ = 0;        ///< the colours chosen before deviations were
    bool isWanted_ = true;  ///< deviations come back by themselves where they were looked at last
};

}  // namespace skincal
