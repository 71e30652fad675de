#pragma once

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

  signals:
    void moduleSelected(skincal::ModuleId module);

  private:
    void refresh();
    void showNetwork();
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
