#include "ui/presenters/skin_offer.h"

#include <QCoreApplication>

#include "core/device/protocol_skin.h"

namespace skincal {

Offer<SkinDevice> offerOfAddress(const LineAddress& address, std::vector<ModuleTemplate> types) {
    return {address.text, QCoreApplication::translate("SkinOffer", "A skin at this address"),
            [address, types = std::move(types)] { return std::make_unique<ProtocolSkin>(address, types); },
            QStringLiteral("address:") + address.text};
}

}  // namespace skincal
