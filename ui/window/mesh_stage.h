#pragma once

#include <QObject>

#include "ui/presenters/mesh_presenter.h"
#include "ui/scene3d/body_words.h"

class QComboBox;

namespace skincal {

class BodyViewWidget;

/// What the 3D view shows of a comparison with a mesh: the mesh about the body, and a choice of colours that is there
/// only as long as deviations are.
class MeshStage : public QObject {
    Q_OBJECT
  public:
    /// All three outlive this.
    /// @param colours  its items' data are ColourModes
    MeshStage(MeshPresenter& presenter, BodyViewWidget& view, QComboBox& colours, QObject* parent);

  private:
    void arrange();
    void offerDeviations(bool offered);

    MeshPresenter& presenter_;
    BodyViewWidget& view_;
    QComboBox& colours_;
    std::shared_ptr<const MeshComparison> shown_;
    int before_ = 0;        ///< the colours chosen before deviations were
    bool isWanted_ = true;  ///< deviations come back by themselves where they were looked at last
};

}  // namespace skincal
