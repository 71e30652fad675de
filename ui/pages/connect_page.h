#pragma once

#include "core/device/line_address.h"
#include "ui/pages/page.h"
#include "ui/presenters/connect_presenter.h"

class QComboBox;
class QPushButton;
class QTableView;

namespace skincal {

class NetworkView;

class ConnectPage : public Page {
    Q_OBJECT
  public:
    ConnectPage(Workbench& workbench, ConnectPresenter& presenter, QWidget* parent = nullptr);

    /// Puts it among the devices, where it is not there yet, and chooses it.
    void useAddress(const LineAddress& address);

  signals:
    void moduleSelected(skincal::ModuleId module);

  private:
    void refresh();
    void showNetwork();
    void listDevices();
    void chooseDevice(int offer);
    void askForAddress();
    void overruleSelected(std::optional<LinkKind> kind);

    Workbench& workbench_;
    ConnectPresenter& presenter_;
    QComboBox* devices_;
    QPushButton* connect_;
    QLabel* status_;
    NetworkView* network_;
    QTableView* links_;
    QPushButton* callCable_;
    QPushButton* callNeighbours_;
    QPushButton* askData_;
};

}  // namespace skincal
