#pragma once

#include <QWidget>

class QComboBox;
class QLabel;

namespace skincal {

class BodyViewWidget;

/// The body in 3D, always there on the right, with what can be set of how it is shown.
class BodyPanel : public QWidget {
    Q_OBJECT
  public:
    explicit BodyPanel(QWidget* parent = nullptr);

    [[nodiscard]] BodyViewWidget& view() { return *view_; }
    [[nodiscard]] QComboBox& colours() { return *colours_; }
    /// Whether the body that is shown is of before the last change.
    void setStale(bool stale);

  private:
    BodyViewWidget* view_;
    QComboBox* colours_;
    QLabel* stale_;
};

}  // namespace skincal
