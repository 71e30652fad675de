#include "ui/presenters/workbench.h"

#include <algorithm>

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

void Workbench::setCameraOffers(std::vector<Offer<FrameSource>> offers) {
    if (chosenCamera_ >= 0) {
        const auto& chosen = cameraOffers.at(static_cast<std::size_t>(chosenCamera_));
        const auto found = std::find_if(offers.begin(), offers.end(), [&](const auto& offer) {
            return offer.key == chosen.key && (!offer.key.isEmpty() || offer.name == chosen.name);
        });
        chosenCamera_ = found == offers.end() ? -1 : static_cast<int>(found - offers.begin());
    }
    cameraOffers = std::move(offers);
    emit cameraOffersChanged();
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
