#include "ui/presenters/workbench.h"

#include <algorithm>

namespace skincal {

const RigHands* Workbench::handsOnSkin() const {
    if (!hands)
        return nullptr;
    const auto& modules = session_.measured().skin.modules;
    const bool areTheirs = std::all_of(modules.begin(), modules.end(), [&](const SkinModule& module) {
        return !hands->holds || hands->holds(module.id);
    });
    return areTheirs ? &*hands : nullptr;
}

void Workbench::chooseSkin(std::size_t offer) {
    setSkinReady(false);
    skin_ = skinOffers.at(offer).make();
    chosenSkin_ = static_cast<int>(offer);
    emit skinChosen();
}

void Workbench::chooseCamera(std::size_t offer) {
    camera_ = cameraOffers.at(offer).make();
    chosenCamera_ = static_cast<int>(offer);
    cameraLag_ = {};
    emit cameraChosen();
}

namespace {

/// Where the chosen one is among other offers, -1 where it is not.
template <class Device>
int placeAmong(const std::vector<Offer<Device>>& offers, const std::vector<Offer<Device>>& before, int chosen) {
    if (chosen < 0)
        return -1;
    const Offer<Device>& one = before.at(static_cast<std::size_t>(chosen));
    const auto found = std::find_if(offers.begin(), offers.end(), [&](const auto& offer) {
        return offer.key == one.key && (!offer.key.isEmpty() || offer.name == one.name);
    });
    return found == offers.end() ? -1 : static_cast<int>(found - offers.begin());
}

}  // namespace

void Workbench::setCameraOffers(std::vector<Offer<FrameSource>> offers) {
    chosenCamera_ = placeAmong(offers, cameraOffers, chosenCamera_);
    cameraOffers = std::move(offers);
    emit cameraOffersChanged();
}

void Workbench::setSkinOffers(std::vector<Offer<SkinDevice>> offers) {
    chosenSkin_ = placeAmong(offers, skinOffers, chosenSkin_);
    skinOffers = std::move(offers);
    emit skinOffersChanged();
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
