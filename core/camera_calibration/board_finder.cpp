#include "core/camera_calibration/board_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/camera_calibration/charuco.h"
#include "core/geometry/statistics.h"

namespace skincal {
namespace {

cv::Mat greyOf(const cv::Mat& picture) {
    if (picture.depth() != CV_8U || picture.dims != 2)
        throw std::logic_error("findBoard: a picture of 8 bits");
    cv::Mat grey = picture;
    if (picture.channels() == 3)
        cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    else if (picture.channels() == 4)
        cv::cvtColor(picture, grey, cv::COLOR_BGRA2GRAY);
    else if (picture.channels() != 1)
        throw std::logic_error("findBoard: a picture of 1, 3 or 4 channels");
    return grey;
}

/// Fewer rows than this and cv::aruco and the detector of chessboards read past their own windows.
constexpr int kSmallestPicture = 64;

std::vector<BoardCorner> chessboardCorners(const cv::Mat& grey, const BoardPlan& plan) {
    const cv::Size inner(plan.columns - 1, plan.rows - 1);
    std::vector<cv::Point2f> found;
    // The newer detector (findChessboardCornersSB) takes a hundred times as long, too long for every live frame, and is
    // less exact than cornerSubPix on a sharp board.
    constexpr int kFlags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
    if (!cv::findChessboardCorners(grey, inner, found, kFlags) ||
        found.size() != static_cast<std::size_t>(plan.cornerCount()))
        return {};
    // The detector may start at either end and run either way round; a board seen from its front turns x into y
    // clockwise.
    const auto at = [&](int column, int row) { return found[static_cast<std::size_t>(row * inner.width + column)]; };
    const cv::Point2f right = at(inner.width - 1, 0) - at(0, 0);
    const cv::Point2f down = at(0, inner.height - 1) - at(0, 0);
    const bool mirrored = right.cross(down) < 0;
    std::vector<BoardCorner> corners;
    for (int row = 0; row < inner.height; ++row) {
        for (int column = 0; column < inner.width; ++column) {
            const cv::Point2f p = at(mirrored ? inner.width - 1 - column : column, row);
            corners.push_back({row * inner.width + column, {static_cast<double>(p.x), static_cast<double>(p.y)}});
        }
    }
    return corners;
}

double medianOrZero(std::vector<double> values) {
    return values.empty() ? 0 : median(std::move(values));
}

double bilinear(const cv::Mat& grey, const Vector2d& p) {
    const int x = std::clamp(static_cast<int>(std::floor(p.x())), 0, grey.cols - 2);
    const int y = std::clamp(static_cast<int>(std::floor(p.y())), 0, grey.rows - 2);
    const double a = std::clamp(p.x() - x, 0.0, 1.0);
    const double b = std::clamp(p.y() - y, 0.0, 1.0);
    const std::uint8_t* r0 = grey.ptr<std::uint8_t>(y) + x;
    const std::uint8_t* r1 = grey.ptr<std::uint8_t>(y + 1) + x;
    return (1 - b) * ((1 - a) * r0[0] + a * r0[1]) + b * ((1 - a) * r1[0] + a * r1[1]);
}

/// Brightness across the edge from `a` to `b`, black first, averaged along the middle of the edge: near its ends other
/// edges come close.
std::vector<double> profileAcross(const cv::Mat& grey, const Vector2d& a, const Vector2d& b, double reach,
                                  double spacing) {
    const Vector2d along = b - a;
    const Vector2d across = Vector2d(-along.y(), along.x()).normalized();
    constexpr std::array kPlaces{0.4, 0.45, 0.5, 0.55, 0.6};
    std::vector<double> profile;
    for (double t = -reach; t <= reach; t += spacing) {
        double sum = 0;
        for (const double place : kPlaces)
            sum += bilinear(grey, a + place * along + t * across);
        profile.push_back(sum / static_cast<double>(kPlaces.size()));
    }
    if (profile.front() > profile.back())
        std::reverse(profile.begin(), profile.end());
    return profile;
}

/// Width between 20 % and 80 % of the step across the edge from `a` to `b`, in pixels; negative without contrast.
double edgeWidth(const cv::Mat& grey, const Vector2d& a, const Vector2d& b, double reach) {
    constexpr double kSpacing_px = 0.25;
    constexpr double kContrast = 20;
    const std::vector<double> profile = profileAcross(grey, a, b, reach, kSpacing_px);
    const std::size_t ends = std::max<std::size_t>(1, profile.size() / 10);
    double low = 0;
    double high = 0;
    for (std::size_t i = 0; i < ends; ++i) {
        low += profile[i] / static_cast<double>(ends);
        high += profile[profile.size() - 1 - i] / static_cast<double>(ends);
    }
    if (high - low < kContrast)
        return -1;
    // From the middle of the step outwards, so that noise in the flat parts doesn't count.
    std::size_t middle = 1;
    while (middle + 1 < profile.size() && profile[middle] < (low + high) / 2)
        ++middle;
    const auto crossing = [&](double share) {
        const double level = low + share * (high - low);
        std::size_t i = middle;
        while (i > 1 && profile[i - 1] > level)
            --i;
        while (i + 1 < profile.size() && profile[i] < level)
            ++i;
        const double rise = profile[i] - profile[i - 1];
        return kSpacing_px * (static_cast<double>(i) - 1 + (rise > 0 ? (level - profile[i - 1]) / rise : 0));
    };
    return std::max(0.0, crossing(0.8) - crossing(0.2));
}

/// Moves corners onto their saddle points. The window holds nothing of the next corner or marker.
void refine(const cv::Mat& grey, const BoardPlan& plan, double shortest_px, BoardView& view) {
    const double share = plan.kind == BoardKind::Chessboard ? 0.35 : 0.45 * (plan.square - plan.marker) / plan.square;
    const int half = std::clamp(static_cast<int>(share * shortest_px), 2, 12);
    std::vector<cv::Point2f> points;
    for (const BoardCorner& corner : view.corners)
        points.emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
    cv::cornerSubPix(grey, points, {half, half}, {-1, -1}, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-4});
    for (std::size_t i = 0; i < points.size(); ++i)
        view.corners[i].pixel = {static_cast<double>(points[i].x), static_cast<double>(points[i].y)};
}

/// Calls f(direction, a, b) for neighbours along rows (0) and columns (1).
template <class F>
void forNeighbours(const BoardPlan& plan, const BoardView& view, F f) {
    std::vector<const Vector2d*> at(static_cast<std::size_t>(plan.cornerCount()), nullptr);
    for (const BoardCorner& corner : view.corners)
        at.at(static_cast<std::size_t>(corner.id)) = &corner.pixel;
    const int across = plan.columns - 1;
    for (int id = 0; id < plan.cornerCount(); ++id) {
        const Vector2d* a = at.at(static_cast<std::size_t>(id));
        if (a == nullptr)
            continue;
        const Vector2d* right = id % across + 1 < across ? at.at(static_cast<std::size_t>(id + 1)) : nullptr;
        const Vector2d* down =
            id + across < plan.cornerCount() ? at.at(static_cast<std::size_t>(id + across)) : nullptr;
        if (right != nullptr)
            f(0U, *a, *right);
        if (down != nullptr)
            f(1U, *a, *down);
    }
}

}  // namespace

bool BoardFinderOptions::validate() const {
    return minCorners >= 6 && minSquare_px >= 8 && maxBlur_px > 0.3;
}

double measureBlur(const cv::Mat& grey, const BoardPlan& plan, const BoardView& view) {
    constexpr double kSigmasOfWidth = 1.6832;
    const double free = plan.kind == BoardKind::Chessboard ? 0.35 : 0.45 * (plan.square - plan.marker) / plan.square;
    // Of a square seen aslant the other direction may be shorter: measured there.
    std::array<std::vector<double>, 2> sides;
    forNeighbours(plan, view, [&](std::size_t direction, const Vector2d& a, const Vector2d& b) {
        sides.at(direction).push_back((b - a).norm());
    });
    const std::array typical{medianOrZero(sides[0]), medianOrZero(sides[1])};
    std::array<std::vector<double>, 2> widths;
    forNeighbours(plan, view, [&](std::size_t direction, const Vector2d& a, const Vector2d& b) {
        const double other = typical.at(1 - direction) > 0 ? typical.at(1 - direction) : (b - a).norm();
        const double width = edgeWidth(grey, a, b, free * other);
        if (width >= 0)
            widths.at(direction).push_back(width);
    });
    return std::max(medianOrZero(widths[0]), medianOrZero(widths[1])) / kSigmasOfWidth;
}

tl::expected<BoardView, BoardFault> findBoard(const cv::Mat& picture, const BoardPlan& plan,
                                              const BoardFinderOptions& options) {
    if (!plan.validate() || !options.validate())
        throw std::logic_error("findBoard: plan or options out of range");
    if (picture.rows < kSmallestPicture || picture.cols < kSmallestPicture)
        return tl::unexpected(BoardFault{});
    const cv::Mat grey = greyOf(picture);
    BoardView view;
    view.size = grey.size();
    try {
        view.corners = plan.kind == BoardKind::Chessboard ? chessboardCorners(grey, plan) : charucoCorners(grey, plan);
    } catch (const cv::Exception&) {
        // Some pictures without a board make OpenCV's detectors fail an assertion of their own.
        return tl::unexpected(BoardFault{});
    }
    if (view.corners.empty())
        return tl::unexpected(BoardFault{});
    const int needed = std::min(options.minCorners, plan.cornerCount());
    if (static_cast<int>(view.corners.size()) < needed)
        return tl::unexpected(BoardFault{BoardMiss::TooFewCorners, static_cast<double>(view.corners.size()),
                                         static_cast<double>(needed)});
    std::vector<double> sides;
    forNeighbours(plan, view,
                  [&](std::size_t, const Vector2d& a, const Vector2d& b) { sides.push_back((b - a).norm()); });
    view.square_px = medianOrZero(sides);
    if (view.square_px < options.minSquare_px)
        return tl::unexpected(BoardFault{BoardMiss::TooSmall, view.square_px, options.minSquare_px});
    refine(grey, plan, *std::min_element(sides.begin(), sides.end()), view);
    view.blur_px = measureBlur(grey, plan, view);
    if (view.blur_px > options.maxBlur_px)
        return tl::unexpected(BoardFault{BoardMiss::Blurred, view.blur_px, options.maxBlur_px});
    return view;
}

}  // namespace skincal
