#include "ui/window/mesh_stage.h"

#include <vtkPolyData.h>

#include <QComboBox>
#include <QtConcurrent/QtConcurrentRun>

#include "ui/scene3d/body_view_widget.h"
#include "ui/scene3d/mesh_data.h"

namespace skincal {

MeshStage::MeshStage(MeshPresenter& presenter, BodyViewWidget& view, QComboBox& colours, QObject* parent)
    : QObject(parent), presenter_(presenter), view_(view), colours_(colours) {
    connect(&presenter, &MeshPresenter::changed, this, &MeshStage::arrange);
    connect(&ready_, &QFutureWatcherBase::finished, this, [this] {
        if (shown_ && drawn_ == shown_)
            view_.setMesh(ready_.result());
    });
}

MeshStage::~MeshStage() {
    ready_.disconnect(this);
    ready_.waitForFinished();
}

void MeshStage::arrange() {
    const auto& comparison = presenter_.comparison();
    if (comparison == shown_) {
        isWanted_ = isWanted_ || !presenter_.hasMesh();
        return;
    }
    shown_ = comparison;
    std::map<ModuleId, double> deviations;
    if (!comparison) {
        offerDeviations(false);
        view_.setDeviations({});
        view_.setMesh(nullptr);
        isWanted_ = isWanted_ || !presenter_.hasMesh();
        return;
    }
    for (const ModuleDeviation& module : comparison->modules)
        deviations[module.id] = module.deviation;
    view_.setDeviations(std::move(deviations));
    // A scan of a body has a million triangles: longer than a frame.
    drawn_ = comparison;
    const auto make = [mesh = presenter_.mesh(), T_body_mesh = Isometry3d(comparison->T_mesh_body.inverse())] {
        return toPolyData(*mesh, T_body_mesh);
    };
    ready_.setFuture(QtConcurrent::run(make));
    offerDeviations(true);
}

void MeshStage::offerDeviations(bool offered) {
    const int mode = static_cast<int>(ColourMode::Deviation);
    const int at = colours_.findData(mode);
    if (offered && at < 0) {
        colours_.addItem(tr("Deviation from the mesh"), mode);
        if (isWanted_) {
            before_ = colours_.currentIndex();
            colours_.setCurrentIndex(colours_.count() - 1);
        }
    } else if (!offered && at >= 0) {
        isWanted_ = colours_.currentIndex() == at;
        if (isWanted_)
            colours_.setCurrentIndex(before_);
        colours_.removeItem(at);
    }
}

}  // namespace skincal
