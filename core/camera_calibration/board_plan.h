#pragma once

#include <string_view>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

enum class BoardKind {
    Chessboard,  ///< black and white squares; seen only as a whole
    Charuco,     ///< markers in the white squares (OpenCV's ChArUco); any part of it will do, up to the picture's edge
};

/// Predefined ArUco dictionaries, in OpenCV's order: bits of a marker, number of markers.
enum class MarkerDictionary {
    Dict4x4_50,
    Dict4x4_100,
    Dict4x4_250,
    Dict4x4_1000,
    Dict5x5_50,
    Dict5x5_100,
    Dict5x5_250,
    Dict5x5_1000,
    Dict6x6_50,
    Dict6x6_100,
    Dict6x6_250,
    Dict6x6_1000,
    Dict7x7_50,
    Dict7x7_100,
    Dict7x7_250,
    Dict7x7_1000,
};

[[nodiscard]] std::string_view name(MarkerDictionary dictionary);  ///< as OpenCV spells it: "DICT_5X5_100"
[[nodiscard]] int markerCount(MarkerDictionary dictionary);
[[nodiscard]] int markerBits(MarkerDictionary dictionary);  ///< along one side, without the black border

/// An upright rectangle of the board, black where it is printed.
struct BoardCell {
    double x = 0;  ///< m, left
    double y = 0;  ///< m, top
    double width = 0;
    double height = 0;
};

/// What a calibration board looks like. Board frame `b`: origin at the outer top-left corner of the squares, x right
/// along the columns, y down along the rows, z into the board: a camera that faces it squarely has T_v_b without turn.
struct BoardPlan {
    BoardKind kind = BoardKind::Charuco;
    int columns = 9;        ///< squares, not inner corners
    int rows = 6;           ///< squares
    double square = 0.025;  ///< m
    double marker = 0.019;  ///< m, with its black border; of ChArUco only
    MarkerDictionary dictionary = MarkerDictionary::Dict5x5_100;

    /// 3 to 40 squares each way, squares of 1 mm to 1 m and, of ChArUco, markers of 0.4 to 0.9 squares and enough of
    /// them in the dictionary.
    [[nodiscard]] bool validate() const;

    [[nodiscard]] double width() const { return columns * square; }  ///< m
    [[nodiscard]] double height() const { return rows * square; }    ///< m
    /// Inner corners; corner `id` = row * (columns - 1) + column counts along the rows from the top left.
    [[nodiscard]] int cornerCount() const { return (columns - 1) * (rows - 1); }
    /// p_b of an inner corner, m. Throws std::logic_error for an id that isn't there.
    [[nodiscard]] Vector3d corner(int id) const;
};

/// Whether both plans print as the same board: what a chessboard's plan says of markers makes no difference.
[[nodiscard]] bool isSameBoard(const BoardPlan& a, const BoardPlan& b);

/// Everything black on the board, for printing and drawing; whatever isn't covered is white. The top-left square is
/// black, as OpenCV up to 4.6 (and boards made for it) has it. Throws std::logic_error for a plan that isn't valid.
[[nodiscard]] std::vector<BoardCell> blackCells(const BoardPlan& plan);

}  // namespace skincal
