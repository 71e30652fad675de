#pragma once

#include <QObject>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "core/rig/held_board.h"
#include "core/rig/held_body.h"
#include "core/rig/held_camera.h"
#include "core/rig/rig_clock.h"
#include "core/rig/shutter.h"
#include "core/rig/touch_field.h"
#include "core/simulation/world.h"

namespace skincal {

/// A desk with a simulated world on it: a body in somebody's hands, covered with skin, and a webcam. SimulatedSkin and
/// SimulatedCamera are what a computer on the desk is connected to; this is what people do there. Everything goes by
/// the rig's own clock (see RigClock; setSpeed(0) makes tests quick and repeatable), signals come from the event loop.
/// For one thread.
///
/// Faults of the scenario: modules and patches that moved read gravity as before they moved and are seen where they
/// are since, wrong ports and templates are reported. Shaken poses and knocked views have no meaning here: turn the
/// body, or knockCamera().
class SimulatedRig : public QObject {
    Q_OBJECT
  public:
    using Time = RigClock::Time;

    /// Throws std::logic_error where buildWorld does, and for a scenario without views.
    SimulatedRig(const Scenario& scenario, std::uint64_t seed, QObject* parent = nullptr);

    [[nodiscard]] const World& world() const { return *world_; }
    /// For who may outlive the rig.
    [[nodiscard]] std::shared_ptr<const World> sharedWorld() const { return world_; }

    [[nodiscard]] RigClock& clock() { return clock_; }
    [[nodiscard]] Time now() const { return clock_.now(); }
    /// See RigClock::setSpeed.
    void setSpeed(double speed) { clock_.setSpeed(speed); }

    /// Turns the body over within a second so that this direction points against gravity; bodyRested() follows once the
    /// hands no longer tremble, 1.8 s after the last call. At first the body's z points up. The camera stays where it
    /// is in the body's frame, as if somebody held it there.
    /// @param up_r  body frame, any length but 0, else std::logic_error
    void turnBody(const Vector3d& up_r);
    /// Unit vector against gravity, body frame, now.
    [[nodiscard]] Vector3d up() const { return body_.up(now()); }
    [[nodiscard]] bool isBodyAtRest() const { return now() >= body_.restsAt(); }

    /// Moves the camera within a second; cameraRested() follows, once after the last call. It starts at the first of
    /// suggestedViews(). Throws std::logic_error where the pose is none.
    void moveCamera(const Isometry3d& T_r_v);
    /// Where it is now, body frame.
    [[nodiscard]] Isometry3d cameraPose() const { return camera_.pose(now()); }
    [[nodiscard]] bool isCameraAtRest() const { return now() >= camera_.restsAt(); }
    /// From where the scenario's own views are taken.
    [[nodiscard]] const std::vector<Isometry3d>& suggestedViews() const { return world_->T_r_v; }
    /// Someone knocks against it: it turns at once so that the middle of the picture shifts by so many pixels. A move
    /// that is on its way ends there; cameraRested() follows then.
    void knockCamera(double pixels);

    /// Somebody holds a calibration board before the camera and shows it from all sides, until putBoardAway(). It is
    /// always taken up anew. Throws std::logic_error for a plan that
    /// isn't valid.
    void holdBoard(const BoardPlan& plan);
    void putBoardAway() { board_.reset(); }
    [[nodiscard]] const std::optional<HeldBoard>& heldBoard() const { return board_; }

    /// A fingertip on the body, until release(); call it again and again to drag it.
    /// @param point_r  where on the skin, body frame
    /// @param force    N, not negative
    void touch(const Vector3d& point_r, double force);
    void release();

    /// Unplugs the skin: it fails and closes, its LEDs go dark. Opening it fails until it is plugged in again.
    void pullSkin();
    void plugSkin();
    [[nodiscard]] bool isSkinPlugged() const { return skinPlugged_; }
    /// Unplugs the camera: it fails and stops. Starting it fails until it is plugged in again.
    void pullCamera();
    void plugCamera();
    [[nodiscard]] bool isCameraPlugged() const { return cameraPlugged_; }

    /// Time between a light command and the first picture that shows all of it: 80 ms at first. A picture of time t is
    /// exposed from t - latency on. Throws std::logic_error where it is shorter than the shutter.
    void setCameraLatency(std::chrono::milliseconds latency);
    [[nodiscard]] std::chrono::milliseconds cameraLatency() const { return latency_; }
    /// How long pictures are exposed: at first, a moment. With a shutter that takes its time, what changes meanwhile
    /// shows in part. Throws std::logic_error where it is negative or longer than the latency: pictures come once they
    /// are exposed. (SimulatedCamera::setExposure makes pictures brighter, and does not ask what changes.)
    void setShutter(const Shutter& shutter);
    [[nodiscard]] const Shutter& shutter() const { return shutter_; }

    /// What devices ask and tell. Times may lie a little before now: calls come late where the event loop was busy.
    [[nodiscard]] BodyForces forces(Time time) const { return body_.forces(time); }
    [[nodiscard]] Isometry3d cameraPose(Time time) const { return camera_.pose(time); }
    [[nodiscard]] const std::optional<Contact>& contact() const { return contact_; }
    /// What a picture of that time shows lit, in the first moment of its exposure; and one after the other while it
    /// lasts.
    [[nodiscard]] const std::vector<LitModule>& litAt(Time time) const { return commandAt(time)->lit; }
    [[nodiscard]] std::vector<LitUntil> litDuring(Time time) const;
    /// These on and all others off, commanded now.
    void light(std::vector<LitModule> lit);

  signals:
    void bodyRested();
    void cameraRested();
    /// At once, not from the event loop.
    void skinPulled();
    void cameraPulled();

  private:
    struct Command {
        Time time{};
        std::vector<LitModule> lit;
    };

    void restCameraAt(Time when);
    [[nodiscard]] std::deque<Command>::const_iterator commandAt(Time time) const;

    std::shared_ptr<const World> world_;
    RigClock clock_;
    HeldBody body_;
    HeldCamera camera_;
    std::uint64_t turns_ = 0;
    std::uint64_t moves_ = 0;
    std::optional<Contact> contact_;
    std::optional<HeldBoard> board_;
    bool skinPlugged_ = true;
    bool cameraPlugged_ = true;
    std::chrono::milliseconds latency_{80};
    Shutter shutter_;
    std::deque<Command> commands_;  ///< never empty; in the order of time
};

}  // namespace skincal
