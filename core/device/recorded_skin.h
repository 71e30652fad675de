#pragma once

#include <functional>

#include "core/device/skin_device.h"

namespace skincal {

/// The skin of a recording, for looking at it in the window that otherwise shows a real one: explore() gives what was
/// recorded, light() is acknowledged at once, and nothing streams.
class RecordedSkin : public SkinDevice {
    Q_OBJECT
  public:
    RecordedSkin(QString name, Skin skin, QObject* parent = nullptr);

    [[nodiscard]] QString name() const override { return name_; }
    void open() override;
    void close() override;
    /// Fails where it is not open.
    void explore() override;
    void streamAcceleration(bool on) override;
    void streamTactile(bool on) override;
    std::uint64_t light(const std::vector<LitModule>& lit) override;

  private:
    /// From the event loop, unless it has been opened or closed meanwhile.
    void later(std::function<void()> what);

    QString name_;
    Skin skin_;
    bool open_ = false;
    std::uint64_t session_ = 0;
    std::uint64_t token_ = 0;
};

}  // namespace skincal
