#pragma once

#include <QWidget>

#include "ui/presenters/model_overlay.h"
#include "ui/presenters/workbench.h"

class QCheckBox;
class QComboBox;
class QLabel;

namespace skincal {

class PictureView;

/// The solved body on the picture of one of the views: outlines where the body has the boards, rings where LEDs were
/// found, lines along the residuals.
class PicturePanel : public QWidget {
    Q_OBJECT
  public:
    explicit PicturePanel(Workbench& workbench, QWidget* parent = nullptr);

    /// Nothing is projected while nobody looks.
    void setActive(bool active);
    void setSelected(std::optional<ModuleId> module);
    /// In so many words, for tests and screen readers.
    [[nodiscard]] QString figures() const;

  signals:
    void moduleSelected(skincal::ModuleId module);

  protected:
    void showEvent(QShowEvent* event) override;

  private:
    void listViews();
    void showView();
    void showPicture(const std::string& view);
    void showOverlay(const ModelOverlay& overlay);

    Workbench& workbench_;
    QComboBox* views_;
    QCheckBox* hidden_;
    PictureView* picture_;
    QLabel* summary_;
    QLabel* figures_;
    bool isActive_ = false;
    bool isStale_ = true;
    bool hasPicture_ = false;
};

}  // namespace skincal
