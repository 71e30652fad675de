#include "ui/presenters/workbench.h"

namespace skincal {

void Workbench::chooseSkin(std::size_t offer) {
    setSkinReady(false);
    skin_ = skinOffers.at(offer).make();
    chosenSkin_ = static_cast<int>(offer);
    emit skinChosen();
}

void Workbench::chooseCamera(std::size_t offer) {
    camera_ = cameraOffers.at(offer).make();
    chosenCamera_ = static_cast<int>(offer);
    emit cameraChosen();
}

void Workbench::setSkinReady(bool ready) {
    if (std::exchange(isSkinReady_, ready) != ready)
        emit skinReadyChanged(ready);
}

void Workbench::setScanning(bool scanning) {
    if (std::exchange(isScanning_, scanning) != scanning)
        emit scanningChanged(scanning);
}

}  // namespace skincal
