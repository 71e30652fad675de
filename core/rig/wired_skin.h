#pragma once

#include <QByteArray>
#include <QObject>
#include <QPointer>
#include <QTimer>
#include <memory>

#include "core/rig/rig_senses.h"
#include "core/rig/simulated_rig.h"
#include "core/virtual_skin/virtual_network.h"

namespace skincal {

/// A rig's skin behind a wire: virtual cells that run the reference firmware, feel what the rig's body feels and light
/// the LEDs that its cameras see. Bytes go in and come out at the rate of the wire, by the rig's clock.
class WiredSkin : public QObject, private CellSenses {
    Q_OBJECT
  public:
    /// Throws std::logic_error where VirtualNetwork does, and for a skin on which no port is free.
    WiredSkin(SimulatedRig& rig, const WireFaults& faults, QObject* parent = nullptr);

    /// From the computer.
    void receive(const QByteArray& bytes);
    /// To kill, restart and cut; pump() afterwards.
    [[nodiscard]] VirtualNetwork& network() { return *network_; }
    /// Lets happen what is due by now.
    void pump();

  signals:
    /// For the computer.
    void sent(const QByteArray& bytes);

  private:
    Vector3d acceleration(std::size_t cell, CellSenses::Time time) override;
    double temperature(std::size_t cell, CellSenses::Time time) override;
    Touch touch(std::size_t cell, CellSenses::Time time) override;
    void showLeds();

    QPointer<SimulatedRig> rig_;
    RigSenses senses_;
    Random noise_;
    std::unique_ptr<VirtualNetwork> network_;
    CellSenses::Time started_{};  ///< rig's time at the network's beginning
    CellSenses::Time feltAt_{};
    bool ledsChanged_ = false;
    QTimer timer_;
};

}  // namespace skincal
