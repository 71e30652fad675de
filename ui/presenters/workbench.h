#pragma once

#include <QObject>
#include <QString>
#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/camera/frame_source.h"
#include "core/camera_calibration/board_plan.h"
#include "core/device/skin_device.h"
#include "core/mesh/triangle_mesh.h"
#include "core/session/session.h"

namespace skincal {

/// Something that could be opened, as a list shows it.
template <class Device>
struct Offer {
    QString name;
    QString description;
    std::function<std::unique_ptr<Device>()> make;
    QString key{};  ///< the same as long as it is the same device; empty for one that never goes
};

/// Hands that do what the window asks for: only a simulated rig has them. Relative to a module, since nobody but the
/// rig knows where its body frame is.
struct RigHands {
    /// Whether it is a module of the rig's body: the document may be of another skin.
    std::function<bool(ModuleId)> holds;
    /// Turns the body until this direction of the module points against gravity.
    std::function<void(ModuleId, const Vector3d& up_u)> turnBody;
    /// Puts the camera there.
    std::function<void(ModuleId, const Isometry3d& T_u_v)> moveCamera;
    /// Puts the camera to the next of the rig's own places, for while nothing is placed.
    std::function<void()> moveCameraOn;
    /// A fingertip presses on a point of the module, N, until release(); again and again to drag it.
    std::function<void(ModuleId, const Vector3d& point_u, double force)> touch;
    std::function<void()> release;
    /// Shows such a calibration board to the camera from all sides, until putBoardAway().
    std::function<void(const BoardPlan&)> holdBoard;
    std::function<void()> putBoardAway;
    /// The true surface of the body, m, in a frame of its own, as a drawing of it would be.
    std::function<TriangleMesh()> bodySurface;
    /// What the maker of the camera says of its lens.
    std::optional<CameraModel> intrinsics;
};

/// What all presenters share: the document and the devices.
class Workbench : public QObject {
    Q_OBJECT
  public:
    explicit Workbench(QObject* parent = nullptr) : QObject(parent) {}

    [[nodiscard]] Session& session() { return session_; }

    /// Of all modules that a real skin may have.
    std::vector<ModuleTemplate> moduleTypes{paperHexagon(), triangleTemplate(), rectangleTemplate()};
    std::vector<Offer<SkinDevice>> skinOffers;
    std::vector<Offer<FrameSource>> cameraOffers;
    std::optional<RigHands> hands;
    /// Null where there are none, or any module of the document is not of their body.
    [[nodiscard]] const RigHands* handsOnSkin() const;

    /// Null before a device was chosen. Choosing another destroys the one before.
    [[nodiscard]] SkinDevice* skin() const { return skin_.get(); }
    [[nodiscard]] FrameSource* camera() const { return camera_.get(); }
    void chooseSkin(std::size_t offer);
    void chooseCamera(std::size_t offer);
    /// Other cameras can be chosen from now on. The chosen one stays chosen, found by its key, or by its name
    /// where it has none.
    void setCameraOffers(std::vector<Offer<FrameSource>> offers);
    /// The same with skins.
    void setSkinOffers(std::vector<Offer<SkinDevice>> offers);
    [[nodiscard]] int chosenSkin() const { return chosenSkin_; }
    [[nodiscard]] int chosenCamera() const { return chosenCamera_; }

    /// Whether the skin is open and its network known: what streams and lights need.
    [[nodiscard]] bool isSkinReady() const { return isSkinReady_; }
    void setSkinReady(bool ready);

    /// A scan has the LEDs: whoever else lights one spoils its pictures.
    [[nodiscard]] bool isScanning() const { return isScanning_; }
    void setScanning(bool scanning);

    /// From a command to the skin to the picture of the chosen camera that was sure to show it, at the longest, as far
    /// as scans have found out; 0: none has yet.
    [[nodiscard]] std::chrono::microseconds cameraLag() const { return cameraLag_; }
    void noteCameraLag(std::chrono::microseconds lag) { cameraLag_ = std::max(cameraLag_, lag); }

  signals:
    void skinChosen();
    void cameraChosen();
    void cameraOffersChanged();
    void skinOffersChanged();
    void skinReadyChanged(bool ready);
    /// Somebody blinks an LED for a moment.
    void lightsClaimed();
    /// Before a scan's first light and after its last.
    void scanningChanged(bool scanning);

  private:
    Session session_;
    std::unique_ptr<SkinDevice> skin_;
    std::unique_ptr<FrameSource> camera_;
    int chosenSkin_ = -1;
    int chosenCamera_ = -1;
    bool isSkinReady_ = false;
    bool isScanning_ = false;
    std::chrono::microseconds cameraLag_{};
};

}  // namespace skincal
