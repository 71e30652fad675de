#pragma once

#include <QObject>
#include <QTimer>

#include "ui/presenters/workbench.h"

namespace skincal {

/// Keeps the serial ports of this computer among the skins that can be chosen, as they are plugged in and out: behind
/// those of a rig, before addresses that were typed. The chosen one stays in the list while it is unplugged. The skin
/// of a recording that was opened is offered, too: its network can be looked at without the skin.
class SkinOffers : public QObject {
    Q_OBJECT
  public:
    /// @param workbench  must outlive it
    explicit SkinOffers(Workbench& workbench, QObject* parent = nullptr);

  private:
    void refresh();
    void offerRecording(const QString& directory);

    Workbench& workbench_;
    QTimer timer_;
    QStringList known_;
};

}  // namespace skincal
