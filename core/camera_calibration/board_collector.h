#pragma once

#include <optional>
#include <vector>

#include "core/camera_calibration/board_plan.h"
#include "core/camera_calibration/board_view.h"

namespace skincal {

/// Where and how a board sits in its picture, without a calibrated camera.
struct BoardPlacement {
    double x = 0;         ///< 0 where its corners touch the left edge, 1 the right one
    double y = 0;         ///< 0 top, 1 bottom
    double size = 0;      ///< root of the share of the picture that the corners' hull takes
    double turn_deg = 0;  ///< about the picture's upright axis; positive where the right side is farther away
    double tilt_deg = 0;  ///< about its level axis; positive where the lower side is farther away
};

/// Angles come from the plane's homography with a focal length as long as the picture's longer side: right to about a
/// third, enough to tell views apart. At least 4 corners.
[[nodiscard]] BoardPlacement placementOf(const BoardView& view, const BoardPlan& plan);

enum class OfferOutcome {
    Kept,
    Redundant,  ///< too like a view that is kept
    Moving,     ///< the board moved since the last picture, or there was none before: hold it still
    OtherSize,  ///< a picture of another size than those before
};

/// What to ask the operator for.
enum class BoardWish {
    MoreViews,
    LeftEdge,
    RightEdge,
    TopEdge,
    BottomEdge,
    Nearer,
    Farther,
    Turn,       ///< hold it at an angle, left side nearer or right side nearer
    Tilt,       ///< hold it at an angle, upper side nearer or lower side nearer
    FillCells,  ///< show it where the coverage map is empty
};

struct MissingView {
    BoardWish wish = BoardWish::MoreViews;
    double have = 0;  ///< in the wish's own measure: views, BoardPlacement's numbers, share of cells
    double need = 0;
};

struct BoardCollectorOptions {
    bool mustBeStill = true;  ///< false for single photographs
    double stillness_px = 2;  ///< root mean square way of the corners from one offered picture to the next
    /// Least |dx| + |dy| + |dsize| + |dturn|/60 deg + |dtilt|/60 deg to every kept view, until there are `views` of
    /// them.
    double newness = 0.2;
    /// Once there are enough, a view is kept that differs by half of that and fulfils a wish or brings progress() so
    /// much nearer to 1.
    double gain = 0.002;
    int gridColumns = 8;  ///< of the coverage map
    int gridRows = 6;
    int views = 12;         ///< wanted at least
    double edge = 0.15;     ///< x and y of the views nearest to the edges
    double nearSize = 0.5;  ///< size of the nearest view
    double farSize = 0.3;   ///< size of the farthest view
    double angle_deg = 20;  ///< of the most turned and most tilted view, either way
    double coverage = 0.7;  ///< share of cells with corners
    [[nodiscard]] bool validate() const;
};

/// Keeps those views of a live picture that a calibration gains from, by the measures of ROS camera_calibration
/// (position, size and skew; a view is new where it differs enough from every other), and says what is missing. Holds
/// state: one collector for one camera.
class BoardCollector {
  public:
    /// Throws std::logic_error for a plan or options that aren't valid.
    explicit BoardCollector(const BoardPlan& plan, const BoardCollectorOptions& options = {});

    /// Looks at the board of the next picture, and keeps it where it is worth it.
    OfferOutcome offer(const BoardView& view);
    /// Takes the i-th view out again, for the operator.
    void remove(std::size_t i);
    /// Adds a view that was kept before, whatever it adds to those there are. Nothing where they are of another size.
    void takeBack(const BoardView& view);

    [[nodiscard]] const BoardPlan& plan() const { return plan_; }
    [[nodiscard]] const std::vector<BoardView>& views() const { return views_; }
    [[nodiscard]] const std::vector<BoardPlacement>& placements() const { return placements_; }
    /// Corners of kept views in each cell, by rows from the top left: gridRows * gridColumns numbers.
    [[nodiscard]] std::vector<int> coverage() const;
    /// Share of the cells that have a corner.
    [[nodiscard]] double coveredShare() const;
    /// What is missing, what was asked for first coming first; empty where there is enough.
    [[nodiscard]] std::vector<MissingView> missing() const;
    /// 0 to 1, the mean of what is reached of each wish.
    [[nodiscard]] double progress() const;

  private:
    struct Need {
        MissingView numbers;
        double reached = 0;  ///< 0 to 1
    };
    [[nodiscard]] std::vector<Need> needs() const;
    [[nodiscard]] bool isNew(const BoardView& view, const BoardPlacement& placement) const;
    [[nodiscard]] std::size_t cellOf(const BoardView& view, const Vector2d& pixel) const;
    [[nodiscard]] bool isStill(const BoardView& view) const;

    BoardPlan plan_;
    BoardCollectorOptions options_;
    std::vector<BoardView> views_;
    std::vector<BoardPlacement> placements_;
    std::optional<BoardView> last_;  ///< the last one offered, kept or not
};

}  // namespace skincal
