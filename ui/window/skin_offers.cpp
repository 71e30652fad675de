#include "ui/window/skin_offers.h"

#include <QSerialPortInfo>
#include <algorithm>

#include "ui/presenters/skin_offer.h"

namespace skincal {
namespace {

constexpr auto kPort = "port:";
constexpr int kLookEvery_ms = 1000;

QString describe(const QSerialPortInfo& port) {
    QStringList parts{port.manufacturer(), port.description()};
    parts.removeAll(QString());
    parts.removeDuplicates();
    return parts.isEmpty() ? SkinOffers::tr("A serial port") : parts.join(QLatin1Char(' '));
}

/// Ports that are soldered in and lead nowhere, as most computers list some, are not worth a line.
bool isPlugged(const QSerialPortInfo& port) {
    return port.hasVendorIdentifier() || !port.portName().startsWith(QLatin1String("ttyS"));
}

}  // namespace

SkinOffers::SkinOffers(Workbench& workbench, QObject* parent) : QObject(parent), workbench_(workbench), timer_(this) {
    connect(&timer_, &QTimer::timeout, this, &SkinOffers::refresh);
    timer_.start(kLookEvery_ms);
    refresh();
}

void SkinOffers::refresh() {
    QStringList names;
    std::vector<Offer<SkinDevice>> ports;
    for (const QSerialPortInfo& port : QSerialPortInfo::availablePorts()) {
        const auto address = parseLineAddress(port.systemLocation());
        if (!isPlugged(port) || !address)
            continue;
        names.push_back(port.systemLocation());
        Offer<SkinDevice> offer = offerOfAddress(*address, workbench_.moduleTypes);
        offer.name = port.portName();
        offer.description = describe(port);
        offer.key = QLatin1String(kPort) + port.systemLocation();
        ports.push_back(std::move(offer));
    }
    if (names == std::exchange(known_, names))
        return;
    std::vector<Offer<SkinDevice>> offers;
    std::vector<Offer<SkinDevice>> behind;
    for (std::size_t k = 0; k < workbench_.skinOffers.size(); ++k) {
        const Offer<SkinDevice>& offer = workbench_.skinOffers[k];
        const bool isPort = offer.key.startsWith(QLatin1String(kPort));
        const auto isSame = [&](const auto& port) { return port.key == offer.key; };
        const bool isGone = isPort && std::none_of(ports.begin(), ports.end(), isSame);
        if (offer.key.isEmpty())
            offers.push_back(offer);
        else if (!isPort || (isGone && static_cast<int>(k) == workbench_.chosenSkin()))
            behind.push_back(offer);
    }
    std::move(ports.begin(), ports.end(), std::back_inserter(offers));
    std::move(behind.begin(), behind.end(), std::back_inserter(offers));
    workbench_.setSkinOffers(std::move(offers));
}

}  // namespace skincal
