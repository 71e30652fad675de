#include "core/camera_calibration/board_plan.h"

#include <gtest/gtest.h>

#include <opencv2/aruco/charuco.hpp>
#include <set>

namespace skincal {
namespace {

TEST(BoardPlan, BlackCellsDrawWhatOpenCvDraws) {
    for (const int rows : {4, 5}) {
        for (const MarkerDictionary dictionary : {MarkerDictionary::Dict4x4_50, MarkerDictionary::Dict6x6_250}) {
            // 96 pixels a square, 72 or 80 a marker: every bit is a whole number of pixels.
            const int bits = markerBits(dictionary) + 2;
            const int bit = 72 / bits;
            const BoardPlan plan{BoardKind::Charuco, 5, rows, 0.096, bit * bits * 1e-3, dictionary};
            ASSERT_TRUE(plan.validate());
            cv::Mat mine(rows * 96, 5 * 96, CV_8U, cv::Scalar(255));
            const auto at = [](double v) { return static_cast<int>(std::lround(v * 1000)); };
            for (const BoardCell& cell : blackCells(plan))
                mine(cv::Range(at(cell.y), at(cell.y + cell.height)), cv::Range(at(cell.x), at(cell.x + cell.width)))
                    .setTo(0);
            const auto board =
                cv::aruco::CharucoBoard::create(5, rows, 0.096F, static_cast<float>(plan.marker),
                                                cv::aruco::getPredefinedDictionary(static_cast<int>(dictionary)));
            cv::Mat theirs;
            board->draw(mine.size(), theirs, 0, 1);
            EXPECT_LT(cv::countNonZero(mine != theirs), 0.01 * static_cast<double>(mine.total())) << name(dictionary);
        }
    }
}

TEST(BoardPlan, CornersLieBetweenTheSquares) {
    const BoardPlan plan{BoardKind::Chessboard, 9, 6, 0.03, 0, {}};
    EXPECT_EQ(plan.cornerCount(), 40);
    EXPECT_TRUE(plan.corner(0).isApprox(Vector3d(0.03, 0.03, 0)));
    EXPECT_TRUE(plan.corner(8).isApprox(Vector3d(0.03, 0.06, 0)));
    EXPECT_TRUE(plan.corner(39).isApprox(Vector3d(0.24, 0.15, 0)));
    EXPECT_THROW((void)plan.corner(40), std::logic_error);
    EXPECT_THROW((void)plan.corner(-1), std::logic_error);
    EXPECT_EQ(blackCells(plan).size(), 27U);
}

TEST(BoardPlan, DictionariesAreThoseOfOpenCv) {
    std::set<std::string_view> names;
    for (int i = 0; i < 16; ++i) {
        const auto dictionary = static_cast<MarkerDictionary>(i);
        const auto theirs = cv::aruco::getPredefinedDictionary(i);
        EXPECT_EQ(markerBits(dictionary), theirs->markerSize);
        EXPECT_EQ(markerCount(dictionary), theirs->bytesList.rows);
        names.insert(name(dictionary));
    }
    EXPECT_EQ(names.size(), 16U);
}

TEST(BoardPlan, PlansThatCannotBeAreRefused) {
    EXPECT_TRUE(BoardPlan{}.validate());
    const auto refused = [](auto change) {
        BoardPlan plan;
        change(plan);
        EXPECT_FALSE(plan.validate());
        EXPECT_THROW((void)blackCells(plan), std::logic_error);
    };
    refused([](BoardPlan& p) { p.columns = 2; });
    refused([](BoardPlan& p) { p.rows = 41; });
    refused([](BoardPlan& p) { p.square = 0; });
    refused([](BoardPlan& p) { p.square = std::nan(""); });
    refused([](BoardPlan& p) { p.marker = p.square; });
    refused([](BoardPlan& p) { p.marker = 0.1 * p.square; });
    refused([](BoardPlan& p) { p.columns = p.rows = 20; });  // 200 markers of 100
}

TEST(BoardPlan, AreTheSameBoardWhereTheyPrintAsTheSame) {
    const auto isSame = [](BoardPlan plan, auto change) {
        BoardPlan other = plan;
        change(other);
        return isSameBoard(plan, other);
    };
    BoardPlan chess;
    chess.kind = BoardKind::Chessboard;
    for (const BoardPlan& plan : {BoardPlan{}, chess}) {
        EXPECT_TRUE(isSame(plan, [](BoardPlan&) {}));
        EXPECT_FALSE(isSame(plan, [](BoardPlan& p) { ++p.columns; }));
        EXPECT_FALSE(isSame(plan, [](BoardPlan& p) { ++p.rows; }));
        EXPECT_FALSE(isSame(plan, [](BoardPlan& p) { p.square *= 2; }));
        EXPECT_EQ(isSame(plan, [](BoardPlan& p) { p.marker *= 0.9; }), plan.kind == BoardKind::Chessboard);
        EXPECT_EQ(isSame(plan, [](BoardPlan& p) { p.dictionary = MarkerDictionary::Dict6x6_250; }),
                  plan.kind == BoardKind::Chessboard);
    }
    EXPECT_FALSE(isSameBoard(BoardPlan{}, chess));
}

}  // namespace
}  // namespace skincal
