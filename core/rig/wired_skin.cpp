#include "core/rig/wired_skin.h"

#include <stdexcept>

namespace skincal {
namespace {

constexpr std::chrono::microseconds kFeelEvery{10'000};
constexpr std::chrono::milliseconds kTurn{1};

}  // namespace

WiredSkin::WiredSkin(SimulatedRig& rig, const WireFaults& faults, QObject* parent)
    : QObject(parent), rig_(&rig), senses_(rig.sharedWorld()), noise_(rig.world().seed, "wired noise"), timer_(this) {
    const auto root = placeForComputer(rig.world().skin);
    if (!root)
        throw std::logic_error("no port of the skin is free for the computer");
    started_ = rig.now();
    CellSenses& senses = *this;
    network_ = std::make_unique<VirtualNetwork>(rig.world().skin, *root, faults, rig.world().seed, senses);
    network_->onLed([this](std::size_t, std::uint32_t, CellSenses::Time) { ledsChanged_ = true; });
    timer_.setTimerType(Qt::PreciseTimer);
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, &WiredSkin::pump);
    timer_.start(kTurn);
}

void WiredSkin::receive(const QByteArray& bytes) {
    pump();
    network_->fromComputer({reinterpret_cast<const std::uint8_t*>(bytes.constData()),  // NOLINT: bytes are bytes
                            static_cast<std::size_t>(bytes.size())});
    pump();
}

void WiredSkin::pump() {
    if (!rig_)
        return;
    network_->run(rig_->now() - started_);
    if (std::exchange(ledsChanged_, false))
        showLeds();
    const std::vector<std::uint8_t> bytes = network_->takeForComputer();
    if (!bytes.empty())
        emit sent({reinterpret_cast<const char*>(bytes.data()), static_cast<qsizetype>(bytes.size())});  // NOLINT
    if (const auto next = network_->next())
        timer_.start(std::max(kTurn, std::chrono::ceil<std::chrono::milliseconds>(*next - network_->now())));
}

void WiredSkin::showLeds() {
    std::vector<LitModule> lit;
    const Skin& skin = rig_->world().skin;
    for (std::size_t i = 0; i < skin.modules.size(); ++i) {
        const std::uint32_t colour = network_->led(i);
        if (colour == 0)
            continue;
        LitModule one{skin.modules[i].id, std::nullopt};
        if (colour != 0xFFFFFF)
            one.colour = {colour >> 16 & 0xFF ? 1 : 0, colour >> 8 & 0xFF ? 1 : 0, colour & 0xFF ? 1 : 0};
        lit.push_back(one);
    }
    rig_->light(std::move(lit));
}

Vector3d WiredSkin::acceleration(std::size_t cell, CellSenses::Time time) {
    return senses_.acceleration(cell, rig_->forces(started_ + time), noise_);
}

double WiredSkin::temperature(std::size_t cell, CellSenses::Time /*time*/) {
    return senses_.touch(cell, noise_).temperature;
}

CellSenses::Touch WiredSkin::touch(std::size_t cell, CellSenses::Time time) {
    if (time >= feltAt_ + kFeelEvery) {
        senses_.feel(rig_->contact(), started_ + time);
        feltAt_ = time;
    }
    const RigSenses::Touch felt = senses_.touch(cell, noise_);
    return {felt.proximity, felt.force};
}

}  // namespace skincal
