#pragma once

#include <QObject>

#include "ui/presenters/workbench.h"

namespace skincal {

/// A patch and how far it has come.
struct PatchState {
    PatchId patch;
    std::size_t modules = 0;
    bool isPlaced = false;
    std::vector<std::string> views;  ///< that show some of it
};

/// A view and what it shows.
struct ViewState {
    std::string name;
    bool isPlaced = false;
    bool isDropped = false;
    std::size_t found = 0;
    std::optional<double> residual_px;
};

/// Tells where the camera should stand next, and why.
class ViewsPresenter : public QObject {
    Q_OBJECT
  public:
    explicit ViewsPresenter(Workbench& workbench, QObject* parent = nullptr);

    [[nodiscard]] const std::vector<PatchState>& patches() const { return patches_; }
    [[nodiscard]] const std::vector<ViewState>& views() const { return views_; }
    /// Every patch is placed and seen from several sides, as the newest solution has it: there is no need to go on.
    [[nodiscard]] bool isEnough() const;
    /// What is missing, and where to go; one sentence each.
    [[nodiscard]] QString instruction() const;
    [[nodiscard]] QString reason() const;
    /// Where the camera should stand, body frame; nothing while nothing is placed or nothing is forecast.
    [[nodiscard]] std::optional<Isometry3d> target() const;

    [[nodiscard]] bool hasHands() const { return workbench_.handsOnSkin() != nullptr; }
    /// Whether moveCamera() goes to the target: forecasts know placed patches only.
    [[nodiscard]] bool goesToTarget() const;
    /// The rig's camera goes there, or else on to another of its own places, as a person walks round the body to find
    /// what is missing.
    void moveCamera();

  signals:
    void changed();

  private:
    void refresh();
    [[nodiscard]] const NextView* next() const;

    Workbench& workbench_;
    std::vector<PatchState> patches_;
    std::vector<ViewState> views_;
};

}  // namespace skincal
