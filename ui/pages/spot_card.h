#pragma once

#include <QWidget>
#include <array>
#include <string>

class QBoxLayout;
class QLabel;
class QPushButton;

namespace skincal {

struct DetectionRow;
struct OverlayModule;
struct SpotEvidence;
class SpotCrop;
class Workbench;

/// What decided about one module in a view: its surroundings lit and dark, their difference, what a threshold leaves of
/// it and what was fitted, enlarged; and the figures in words.
class SpotCard : public QWidget {
    Q_OBJECT
  public:
    explicit SpotCard(Workbench& workbench, QWidget* parent = nullptr);

    /// Beside the pictures.
    void addButton(QPushButton& button);
    void showDetection(const std::string& view, const DetectionRow& detection);
    void showNothing(const QString& why);

  protected:
    void resizeEvent(QResizeEvent* event) override;

  private:
    enum Crop { Lit, Dark, Difference, Threshold, Fit, Crops };

    void showCrops(const SpotEvidence& evidence, const DetectionRow& detection, const OverlayModule* byBody);

    Workbench& workbench_;
    std::array<SpotCrop*, Crops> crops_{};
    QBoxLayout* buttons_;
    QLabel* text_;
};

}  // namespace skincal
