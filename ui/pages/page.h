#pragma once

#include <QLabel>
#include <QVBoxLayout>
#include <QWidget>

namespace skincal {

/// What every page has: its name, what it is for, and room below.
class Page : public QWidget {
    Q_OBJECT
  public:
    Page(const QString& title, const QString& purpose, QWidget* parent);

    /// The page is shown or not any more: devices run only while somebody looks.
    virtual void setActive(bool active) { Q_UNUSED(active) }

    /// What the keys go to when the page is shown; where there is none, to the highlighted button or the first control.
    [[nodiscard]] virtual QWidget* mainControl() const { return nullptr; }

    /// The least that it takes: where there is less, it scrolls.
    [[nodiscard]] int heightForWidth(int width) const override;

  protected:
    [[nodiscard]] QVBoxLayout& body() { return *layout_; }

  private:
    QVBoxLayout* layout_;
};

/// Buttons below do not move under the pointer when a sentence gets shorter.
void keepTwoLines(QLabel& label);

/// A line of small print.
[[nodiscard]] QLabel* mutedLabel(const QString& text = {});

}  // namespace skincal
