#include "ui/window/skin_offers.h"

#include <QFileInfo>
#include <QSerialPortInfo>
#include <algorithm>

#include "core/device/recorded_skin.h"
#include "ui/presenters/skin_offer.h"

namespace skincal {
namespace {

constexpr auto kPort = "port:";
constexpr auto kRecording = "recording:";
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
    connect(&workbench.session(), &Session::opened, this, &SkinOffers::offerRecording);
    timer_.start(kLookEvery_ms);
    refresh();
}

void SkinOffers::offerRecording(const QString& directory) {
    Offer<SkinDevice> offer;
    offer.name = tr("Recording %1").arg(QFileInfo(directory).fileName());
    offer.description = tr("The network as it was recorded; it does not answer");
    offer.make = [name = offer.name, skin = workbench_.session().measured().skin] {
        return std::make_unique<RecordedSkin>(name, skin);
    };
    offer.key = QLatin1String(kRecording) + directory;
    std::vector<Offer<SkinDevice>> offers = workbench_.skinOffers;
    std::erase_if(offers, [&](const Offer<SkinDevice>& other) { return other.key == offer.key; });
    offers.push_back(std::move(offer));
    workbench_.setSkinOffers(std::move(offers));
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
