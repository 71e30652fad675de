#pragma once

#include <opencv2/core/mat.hpp>
#include <tl/expected.hpp>

#include "core/camera_calibration/board_plan.h"
#include "core/camera_calibration/board_view.h"

namespace skincal {

enum class BoardMiss {
    NotSeen,        ///< no board of this plan in the picture; a chessboard must be in it as a whole
    TooFewCorners,  ///< `found` of `needed` corners
    TooSmall,       ///< squares of `found` pixels, `needed` at least
    Blurred,        ///< blur of `found` pixels, `needed` at most
};

struct BoardFault {
    BoardMiss miss = BoardMiss::NotSeen;
    double found = 0;
    double needed = 0;
};

struct BoardFinderOptions {
    int minCorners = 8;                   ///< a pose and the distortion need more than four
    double minSquare_px = 12;             ///< below, corners of neighbours disturb each other
    double maxBlur_px = 1.5;              ///< standard deviation; a sharp webcam has 0.5 to 1
    [[nodiscard]] bool validate() const;  ///< minCorners 6 and more, minSquare_px 8 and more, maxBlur_px above 0.3
};

/// Finds the board's inner corners to a fraction of a pixel; (0, 0) is the centre of the top-left pixel.
/// @param picture  8 bits, grey, BGR or BGRA.
/// Chessboards by cv::findChessboardCorners, ChArUco by cv::aruco (Garrido-Jurado et al., Pattern Recognition 2014);
/// both refined on the saddle point. A chessboard's corners are counted from either end: its pose is known up to a turn
/// by half, which does a camera's calibration no harm. Throws std::logic_error for options or a plan that aren't valid
/// and for other pictures; an empty picture shows no board.
[[nodiscard]] tl::expected<BoardView, BoardFault> findBoard(const cv::Mat& picture, const BoardPlan& plan,
                                                            const BoardFinderOptions& options = {});

/// How blurred a board is: standard deviation, in pixels, of the Gaussian that would make its edges as wide as they
/// are. Between neighbouring corners the profile across the edge goes from black to white; its width between 20 % and
/// 80 % is 1.683 standard deviations. The median over edges is taken for each of the board's two directions, and the
/// larger counts, as blur by movement widens only the edges across it. The size of the board and its distance don't
/// matter. An edge wider than the profile counts as wide as the profile, so small boards show less than they have:
/// the profile reaches 0.35 squares to each side, of ChArUco to the next marker.
/// Returns 0 where no two neighbouring corners are there.
[[nodiscard]] double measureBlur(const cv::Mat& grey, const BoardPlan& plan, const BoardView& view);

}  // namespace skincal
