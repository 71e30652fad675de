#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/export_presenter.h"

class QListWidget;
class QPlainTextEdit;
class QPushButton;
class QLineEdit;

namespace skincal {

class ExportPage : public Page {
    Q_OBJECT
  public:
    explicit ExportPage(ExportPresenter& presenter, QWidget* parent = nullptr);

    void setActive(bool active) override;

  private:
    void refresh();
    void browse();
    void write();
    void finish(const QString& outcome);
    [[nodiscard]] std::size_t format() const;

    ExportPresenter& presenter_;
    QListWidget* formats_;
    QLabel* description_;
    QPlainTextEdit* preview_;
    QLineEdit* file_;
    QPushButton* write_;
    QLabel* outcome_;
    bool isActive_ = false;
};

}  // namespace skincal
