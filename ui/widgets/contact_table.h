#pragma once

#include <QTableWidget>

#include "ui/presenters/tactile_picture.h"

class QLabel;

namespace skincal {

/// What presses on the skin, the strongest first: module, force, place and normal in the body's frame. A click on a
/// line, or Return there, chooses its module.
class ContactTable : public QTableWidget {
    Q_OBJECT
  public:
    explicit ContactTable(QWidget* parent = nullptr);

    /// Only as many as there are lines: kMostContacts.
    void setContacts(const std::vector<TouchContact>& contacts);

  signals:
    void moduleClicked(skincal::ModuleId module);

  protected:
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void choose(int row);

    std::vector<ModuleId> shown_;
    QLabel* nothing_;
};

}  // namespace skincal
