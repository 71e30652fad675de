#include "ui/window/mesh_stage.h"

#include <vtkPolyData.h>

#include <QComboBox>

#include "ui/scene3d/body_view_widget.h"
#include "ui/scene3d/mesh_data.h"

namespace skincal {

MeshStage::MeshStage(MeshPresenter& presenter, BodyViewWidget& view, QComboBox& colours, QObject* parent)
    : QObject(parent), presenter_(presenter), view_(view), colours_(colours) {
    connect(&presenter, &MeshPresenter::changed, this, &MeshStage::arrange);
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
    view_.setMesh(toPolyData(*presenter_.mesh(), comparison->T_mesh_body.inverse()));
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
