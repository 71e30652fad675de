#pragma once

#include <QObject>
#include <memory>

#include "core/camera/camera_list.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// Keeps the webcams that are plugged in among the cameras that can be chosen: behind those of a rig, before videos.
/// The chosen one stays in the list while it is unplugged. Cameras that this user may not open are listed, too:
/// choosing one says what to do.
class CameraOffers : public QObject {
    Q_OBJECT
  public:
    /// @param workbench  must outlive it
    CameraOffers(Workbench& workbench, std::shared_ptr<CameraList> list, QObject* parent = nullptr);

  private:
    void refresh();

    Workbench& workbench_;
    std::shared_ptr<CameraList> list_;
};

}  // namespace skincal
