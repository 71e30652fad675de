#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/workbench.h"

class QTableWidget;
class QListWidget;

namespace skincal {

class ResultPage : public Page {
    Q_OBJECT
  public:
    explicit ResultPage(Workbench& workbench, QWidget* parent = nullptr);

    /// Rows of the quality table, for tests and reports: what, and its figure.
    [[nodiscard]] static std::vector<std::pair<QString, QString>> figuresOf(const Solution& solution);

  private:
    void refresh();

    Workbench& workbench_;
    QLabel* verdict_;
    QLabel* reason_;
    QTableWidget* figures_;
    QListWidget* reasons_;
};

}  // namespace skincal
