#pragma once

#include <QObject>
#include <QPointer>
#include <QTimer>
#include <set>

#include "core/procedure/connection.h"
#include "ui/presenters/link_model.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// Something about the wiring that the operator should look at.
struct WiringFault {
    enum class Kind { NoLink, DoublyWired, SelfLink };
    Kind kind{};
    std::vector<ModuleId> modules;
};

/// Modules that no link reaches, ports that two links claim, modules linked to themselves.
[[nodiscard]] std::vector<WiringFault> wiringFaults(const Skin& skin);

/// Why a skin was lost; empty where it was not.
/// @param deviceSays  its own words, where it failed
[[nodiscard]] QString sentenceOf(const Connection& connection, const QString& deviceSays);

/// From a list of devices to a skin whose network is known.
class ConnectPresenter : public QObject {
    Q_OBJECT
  public:
    explicit ConnectPresenter(Workbench& workbench, QObject* parent = nullptr);

    [[nodiscard]] const Connection& state() const { return state_; }
    /// A sentence: why the skin was lost. Empty where it was not.
    [[nodiscard]] QString why() const { return sentenceOf(state_, deviceSays_); }
    [[nodiscard]] LinkModel& links() { return links_; }
    [[nodiscard]] const LinkModel& links() const { return links_; }
    /// Those that have reported since the exploration began, in that order.
    [[nodiscard]] const std::vector<ModuleId>& found() const { return found_; }
    /// Modules of the session that the skin, explored anew as something restarted, does not find any more; and how many
    /// it finds that the session does not know. What was measured stays as it is until somebody connects again.
    [[nodiscard]] const std::vector<ModuleId>& gone() const { return gone_; }
    [[nodiscard]] std::size_t strangers() const { return strangers_; }
    /// Modules that did not show the last light that was commanded.
    [[nodiscard]] const std::vector<ModuleId>& dark() const { return dark_; }

    void chooseDevice(int offer);
    void connectSkin();
    void disconnectSkin();
    /// Its LED goes on and off a few times; not during a scan.
    void blink(ModuleId module);

  signals:
    void stateChanged();
    void blinking(skincal::ModuleId module, bool on);

  private:
    void handle(const connection::Event& event);
    void attachDevice();
    void blinkStep();
    void compare(const Skin& skin);

    Workbench& workbench_;
    LinkModel links_;
    Connection state_;
    QString deviceSays_;  ///< when it failed last
    QTimer timer_;
    QTimer blinkTimer_;
    std::vector<ModuleId> found_;
    std::vector<ModuleId> gone_;
    std::size_t strangers_ = 0;
    std::vector<ModuleId> dark_;
    ModuleId blinks_;
    int blinkSteps_ = 0;
};

}  // namespace skincal
