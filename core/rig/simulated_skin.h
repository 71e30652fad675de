#pragma once

#include <QPointer>

#include "core/device/skin_device.h"
#include "core/geometry/random.h"
#include "core/rig/rig_senses.h"
#include "core/rig/simulated_rig.h"

namespace skincal {

/// The skin of a rig, as the computer that it is plugged into knows it. Times are the rig's, from the clock's epoch.
///
/// - open() takes 20 ms; it fails while the skin is unplugged.
/// - explore() reports the modules one by one in the order in which a flood from the first one reaches them, 5 ms each
/// or
///   faster where there are so many that all would not be there within 1.2 s; then World::skin. Of a device that is
///   not open it fails. A second one starts anew.
/// - streams give a sample of all modules each 10 ms, fewer where nobody had time for them for more than a second; they
///   can't be started while it isn't open. Accelerometers are
///   those that simulateGravity reads, each with its own error, on a body that moves (SimulatedRig::turnBody).
/// - light() and lightAt() are acknowledged 4 ms after they take effect, unless a newer command has come by then. They
///   do nothing while it is not open.
/// - unplugged, it fails and closes. It closes without a word where the rig is destroyed.
class SimulatedSkin : public SkinDevice {
    Q_OBJECT
  public:
    explicit SimulatedSkin(SimulatedRig& rig, QObject* parent = nullptr);
    ~SimulatedSkin() override;

    [[nodiscard]] QString name() const override;
    void open() override;
    void close() override;
    void explore() override;
    void streamAcceleration(bool on) override;
    void streamTactile(bool on) override;
    std::uint64_t light(const std::vector<LitModule>& lit) override;
    [[nodiscard]] std::optional<std::chrono::microseconds> now() const override;
    std::uint64_t lightAt(const std::vector<LitModule>& lit, std::chrono::microseconds when) override;

    [[nodiscard]] bool isOpen() const { return state_ == State::Open; }

  private:
    enum class State { Closed, Opening, Open };
    using Time = RigClock::Time;
    using Stream = void (SimulatedSkin::*)(Time);

    /// Calls at that time unless the device has been closed or opened anew meanwhile.
    void at(Time when, std::function<void()> what);
    void soon(std::function<void()> what);
    void shut();
    void unplugged();
    void findNext(std::uint64_t exploration, Time started, std::size_t position);
    void acknowledge(std::uint64_t token);
    void tick(Time when, std::uint64_t SimulatedSkin::*run, std::uint64_t started, Stream sample);
    void sampleAcceleration(Time time);
    void sampleTactile(Time time);

    QPointer<SimulatedRig> rig_;
    std::shared_ptr<const World> world_;
    RigSenses senses_;
    std::vector<std::size_t> order_;  ///< in which modules are found
    Random noise_;
    Random touchNoise_;
    State state_ = State::Closed;
    std::uint64_t session_ = 0;
    std::uint64_t exploration_ = 0;
    std::uint64_t accelerationRun_ = 0;  ///< odd while it streams
    std::uint64_t tactileRun_ = 0;       ///< the same
    std::uint64_t token_ = 0;
};

}  // namespace skincal
