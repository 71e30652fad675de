#pragma once

#include <QThread>
#include <map>
#include <set>

#include "core/device/line_address.h"
#include "core/device/module_register.h"
#include "core/device/skin_device.h"
#include "core/device/skin_worker.h"

namespace skincal {

/// A real skin (or a virtual one) at the end of a line, by the skin protocol. The line lives on a thread of its own, so
/// that a busy window never delays it.
///
/// Modules keep their ids as long as the device lives, and those of remember(), however the network numbers them. Where
/// cells restart the network is explored anew without a word, and explored() comes again only if it has changed.
/// Unplugged, it fails and closes; open() may be called again at any time, and is worth it after cameBack(): of a
/// serial port as it appears, of others every few seconds.
class ProtocolSkin : public SkinDevice {
    Q_OBJECT
  public:
    /// @param templates  of all types of modules that may be there
    ProtocolSkin(LineAddress address, std::vector<ModuleTemplate> templates, QObject* parent = nullptr);
    ~ProtocolSkin() override;

    [[nodiscard]] QString name() const override { return address_.text; }
    void open() override;
    void close() override;
    void explore() override;
    void streamAcceleration(bool on) override;
    void streamTactile(bool on) override;
    std::uint64_t light(const std::vector<LitModule>& lit) override;
    [[nodiscard]] std::optional<std::chrono::microseconds> now() const override { return SkinWorker::now(); }
    std::uint64_t lightAt(const std::vector<LitModule>& lit, std::chrono::microseconds when) override;
    void remember(const Skin& skin) override { modules_.remember(skin); }
    void prepare(const std::vector<std::vector<LitModule>>& sets) override;
    [[nodiscard]] std::vector<SilentModule> silent() const override;

    /// As cells described it in the newest exploration, those included that did not answer.
    [[nodiscard]] const SkinNetwork& network() const { return network_; }

  private:
    enum class State { Closed, Opening, Open };

    void adopt(const SkinNetwork& network, quint64 exploration);
    void forgetNumbers();
    [[nodiscard]] std::optional<ModuleId> moduleOf(CellNumber cell) const;
    void tellLight(std::optional<std::chrono::microseconds> when = {});
    [[nodiscard]] std::vector<LitCell> cellsOf(const std::vector<LitModule>& lit) const;
    void emitAcceleration(const std::vector<RestReading>& readings, qint64 time_us);
    void emitTouch(const std::vector<CellTouch>& touches, qint64 time_us);

    LineAddress address_;
    std::vector<ModuleTemplate> templates_;
    ModuleRegister modules_;
    State state_ = State::Closed;
    quint64 opening_ = 0;
    quint64 exploration_ = 0;                        ///< that gave the numbers
    bool asked_ = false;                             ///< for an exploration
    std::vector<std::optional<ModuleId>> moduleOf_;  ///< by cell number: it is asked a million times a second
    std::map<ModuleId, CellNumber> cellOf_;
    SkinNetwork network_;
    std::set<std::string> known_;  ///< unique ids of the last exploration
    std::vector<LitModule> lit_;
    std::vector<std::vector<LitModule>> prepared_;
    std::uint64_t token_ = 0;
    QThread thread_;
    SkinWorker* worker_;  ///< on thread_, which deletes it
};

}  // namespace skincal
