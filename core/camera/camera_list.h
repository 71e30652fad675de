#pragma once

#include <QObject>
#include <memory>
#include <optional>

#include "core/camera/camera_devices.h"

class QCameraDevice;
class QMediaDevices;

namespace skincal {

/// To be called before anything else of Qt Multimedia, once or more often: keeps GStreamer's PipeWire provider out,
/// which crashed programs that listed cameras (8 of 26 runs with Qt 6.4), by an environment variable.
void prepareMultimedia();

/// The cameras that are plugged in, each once; follows what is plugged in and out. Needs an event loop. For the thread
/// of the application.
class CameraList : public QObject {
    Q_OBJECT
  public:
    /// @param system  must outlive the list
    explicit CameraList(const V4l2System& system = v4l2System(), QObject* parent = nullptr);
    ~CameraList() override;

    [[nodiscard]] const std::vector<ListedCamera>& cameras() const { return cameras_; }
    /// Nodes that this user may not open: no camera of theirs can be listed.
    [[nodiscard]] std::vector<std::string> forbidden() const;
    [[nodiscard]] const V4l2System& system() const { return system_; }

    /// What Qt has under this id at this moment; null where it has nothing.
    [[nodiscard]] static QCameraDevice deviceOf(const ListedCamera& camera);

    /// Looks again; changed() where something is other than before.
    void refresh();

  signals:
    void changed();

  private:
    const V4l2System& system_;
    std::unique_ptr<QMediaDevices> devices_;
    std::vector<ListedCamera> cameras_;
    std::vector<V4l2Node> nodes_;
};

}  // namespace skincal
