#pragma once

#include <QObject>
#include <QString>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/skin/skin.h"
#include "core/vision/frame.h"

namespace skincal {

/// What the accelerometers of the modules that answered read at one time: specific force in each module's frame, m/s^2.
struct AccelerationSample {
    struct Reading {
        ModuleId module;
        Vector3d acceleration = Vector3d::Zero();
    };
    std::chrono::microseconds time{};  ///< of the device's clock
    std::vector<Reading> readings;
};

/// What the skin feels at one time.
struct TactileSample {
    struct Reading {
        ModuleId module;
        float proximity = 0;                  ///< 0 nothing near, 1 touching
        std::array<float, 3> force{};         ///< N, per force cell
        float temperature = 0;                ///< degrees Celsius
        std::array<float, 3> acceleration{};  ///< m/s^2, module frame
    };
    std::chrono::microseconds time{};
    std::vector<Reading> readings;
};

/// A module that is there and said nothing about itself, however often it was asked.
struct SilentModule {
    int number = 0;                ///< in the network, by today's exploration
    std::vector<ModuleId> beside;  ///< modules that say they are linked to it
};

/// A skin that can be asked: over a wire, simulated, or from a recording. Everything is asynchronous: functions return
/// at once, what comes of them is a signal, sent from the event loop, never from inside the call. Signals may come in
/// any order and some never (a cable can be pulled at any time); whoever waits sets a timeout.
class SkinDevice : public QObject {
    Q_OBJECT
  public:
    using QObject::QObject;

    /// What it is, for people: "Simulated arm", "ttyUSB0".
    [[nodiscard]] virtual QString name() const = 0;

    /// opened() or failed() follows. Of an open device: nothing.
    virtual void open() = 0;
    /// closed() follows where it was open. Light, exploration and streams end.
    virtual void close() = 0;
    /// Asks who is there and who is linked to whom: moduleFound() for each module, then explored(), or failed().
    virtual void explore() = 0;
    /// accelerationArrived() at the device's own rate, from now on or no longer.
    virtual void streamAcceleration(bool on) = 0;
    /// tactileArrived(), likewise.
    virtual void streamTactile(bool on) = 0;
    /// These LEDs on and all others off; lightShown(token) follows once every module has latched it. Commands that a
    /// newer one overtakes may never be acknowledged.
    /// @return the token, rising with every call.
    virtual std::uint64_t light(const std::vector<LitModule>& lit) = 0;
    /// Now, on the clock of lightAt() (as a rule std::chrono::steady_clock, as of pictures). Nothing where LEDs can't
    /// be lit at a given time.
    [[nodiscard]] virtual std::optional<std::chrono::microseconds> now() const { return std::nullopt; }
    /// As light(), but at that time, or at once where that is over by the time the cells hear of it. Not before the
    /// last command has been acknowledged: cells need not keep more than one in mind.
    virtual std::uint64_t lightAt(const std::vector<LitModule>& lit, std::chrono::microseconds /*when*/) {
        return light(lit);
    }

    /// Modules of an earlier time: those that have a unique id keep their module ids.
    virtual void remember(const Skin& /*skin*/) {}
    /// Whom the newest exploration counted and could not ask.
    [[nodiscard]] virtual std::vector<SilentModule> silent() const { return {}; }
    /// These will be lit, one after the other or in any order: a device may tell its cells beforehand.
    virtual void prepare(const std::vector<std::vector<LitModule>>& /*sets*/) {}

  signals:
    void opened();
    void closed();
    void failed(const QString& why);
    void moduleFound(skincal::ModuleId module);
    void explored(const skincal::Skin& skin);
    void accelerationArrived(const skincal::AccelerationSample& sample);
    void tactileArrived(const skincal::TactileSample& sample);
    void lightShown(std::uint64_t token);
    /// These don't vouch for having latched the newest command, however often it was repeated.
    void lightMissed(const std::vector<skincal::ModuleId>& dark);
    /// What had failed as it was unplugged is there again: open() may work now.
    void cameBack();
};

}  // namespace skincal
