#pragma once

#include "ui/pages/page.h"
#include "ui/presenters/demo_presenter.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QPushButton;
class QSlider;

namespace skincal {

class ContactTable;
class TracePlot;

/// Of the curve in one of the plot's places.
[[nodiscard]] QColor traceColour(std::size_t place, bool isDark);

class DemoPage : public Page {
    Q_OBJECT
  public:
    explicit DemoPage(DemoPresenter& presenter, QWidget* parent = nullptr);

    void setActive(bool active) override;
    [[nodiscard]] bool isTouchOn() const;
    [[nodiscard]] bool isRaised() const;
    [[nodiscard]] bool isOrbiting() const;

  signals:
    /// What the body should do has changed: any of the three above, or whether the page is shown.
    void stageChanged();
    void fullScreenAsked();

  protected:
    void changeEvent(QEvent* event) override;

  private:
    [[nodiscard]] QLayout* buildControls();
    [[nodiscard]] QLayout* buildCurves();
    [[nodiscard]] QLayout* buildTime();
    void showLive();
    void showTraces();
    void refresh();

    DemoPresenter& presenter_;
    QComboBox* quantity_;
    QCheckBox* raised_;
    QPushButton* touch_;
    QDoubleSpinBox* force_;
    QPushButton* orbit_;
    QLabel* instruction_;
    ContactTable* contacts_;
    QLabel* curves_;
    TracePlot* plot_;
    QCheckBox* follow_;
    QSlider* time_;
    QLabel* ago_;
    QPushButton* live_;
};

}  // namespace skincal
