#include "core/camera_calibration/board_plan.h"

#include <array>
#include <stdexcept>

#include "core/camera_calibration/charuco.h"

namespace skincal {
namespace {

constexpr std::array<std::string_view, 16> kNames{"DICT_4X4_50", "DICT_4X4_100", "DICT_4X4_250", "DICT_4X4_1000",
                                                  "DICT_5X5_50", "DICT_5X5_100", "DICT_5X5_250", "DICT_5X5_1000",
                                                  "DICT_6X6_50", "DICT_6X6_100", "DICT_6X6_250", "DICT_6X6_1000",
                                                  "DICT_7X7_50", "DICT_7X7_100", "DICT_7X7_250", "DICT_7X7_1000"};
constexpr std::array kCounts{50, 100, 250, 1000};

}  // namespace

std::string_view name(MarkerDictionary dictionary) {
    return kNames.at(static_cast<std::size_t>(dictionary));
}

int markerCount(MarkerDictionary dictionary) {
    return kCounts.at(static_cast<std::size_t>(dictionary) % kCounts.size());
}

int markerBits(MarkerDictionary dictionary) {
    return 4 + static_cast<int>(static_cast<std::size_t>(dictionary) / kCounts.size());
}

bool BoardPlan::validate() const {
    constexpr int kMost = 40;
    const bool squares =
        columns >= 3 && columns <= kMost && rows >= 3 && rows <= kMost && square >= 1e-3 && square <= 1;
    if (!squares || kind == BoardKind::Chessboard)
        return squares;
    return marker >= 0.4 * square && marker <= 0.9 * square && columns * rows / 2 <= markerCount(dictionary);
}

Vector3d BoardPlan::corner(int id) const {
    if (id < 0 || id >= cornerCount())
        throw std::logic_error("BoardPlan: no such corner");
    return {(id % (columns - 1) + 1) * square, (id / (columns - 1) + 1) * square, 0};
}

bool isSameBoard(const BoardPlan& a, const BoardPlan& b) {
    return a.kind == b.kind && a.columns == b.columns && a.rows == b.rows && a.square == b.square &&
           (a.kind == BoardKind::Chessboard || (a.marker == b.marker && a.dictionary == b.dictionary));
}

std::vector<BoardCell> blackCells(const BoardPlan& plan) {
    if (!plan.validate())
        throw std::logic_error("BoardPlan out of range");
    std::vector<BoardCell> cells;
    int id = 0;
    for (int row = 0; row < plan.rows; ++row) {
        for (int column = 0; column < plan.columns; ++column) {
            const double x = column * plan.square;
            const double y = row * plan.square;
            if ((row + column) % 2 == 0) {
                cells.push_back({x, y, plan.square, plan.square});
                continue;
            }
            if (plan.kind == BoardKind::Chessboard)
                continue;
            const cv::Mat pattern = markerPattern(plan, id++);
            const double margin = (plan.square - plan.marker) / 2;
            const double bit = plan.marker / pattern.cols;
            for (int v = 0; v < pattern.rows; ++v) {
                // Neighbouring bits in one piece: printed apart, hair lines would show between them.
                for (int u = 0; u < pattern.cols;) {
                    int end = u;
                    while (end < pattern.cols && pattern.at<std::uint8_t>(v, end) == 0)
                        ++end;
                    if (end > u)
                        cells.push_back({x + margin + u * bit, y + margin + v * bit, (end - u) * bit, bit});
                    u = std::max(end, u + 1);
                }
            }
        }
    }
    return cells;
}

}  // namespace skincal
