#include "core/camera_calibration/charuco.h"

#include <algorithm>
#include <opencv2/aruco/charuco.hpp>

namespace skincal {
namespace {

cv::Ptr<cv::aruco::Dictionary> dictionaryOf(const BoardPlan& plan) {
    return cv::aruco::getPredefinedDictionary(static_cast<int>(plan.dictionary));
}

cv::Ptr<cv::aruco::CharucoBoard> boardOf(const BoardPlan& plan) {
    return cv::aruco::CharucoBoard::create(plan.columns, plan.rows, static_cast<float>(plan.square),
                                           static_cast<float>(plan.marker), dictionaryOf(plan));
}

}  // namespace

std::vector<BoardCorner> charucoCorners(const cv::Mat& grey, const BoardPlan& plan) {
    const auto board = boardOf(plan);
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<int> ids;
    cv::aruco::detectMarkers(grey, board->dictionary, markers, ids);
    // Markers of another board of the same dictionary would index past this one's.
    for (std::size_t i = ids.size(); i-- > 0;) {
        if (ids[i] >= static_cast<int>(board->ids.size())) {
            ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(i));
            markers.erase(markers.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
    if (ids.empty())
        return {};
    std::vector<cv::Point2f> points;
    std::vector<int> cornerIds;
    cv::aruco::interpolateCornersCharuco(markers, ids, grey, board, points, cornerIds);
    std::vector<BoardCorner> corners;
    for (std::size_t i = 0; i < points.size(); ++i) {
        // To cv::aruco the centre of the top-left pixel is (0.5, 0.5).
        const Vector2d pixel(static_cast<double>(points[i].x) - 0.5, static_cast<double>(points[i].y) - 0.5);
        if (pixel.x() >= 2 && pixel.y() >= 2 && pixel.x() <= grey.cols - 3 && pixel.y() <= grey.rows - 3)
            corners.push_back({cornerIds[i], pixel});
    }
    std::sort(corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    return corners;
}

cv::Mat markerPattern(const BoardPlan& plan, int id) {
    const auto dictionary = dictionaryOf(plan);
    cv::Mat pattern;
    dictionary->drawMarker(id, dictionary->markerSize + 2, pattern, 1);
    return pattern;
}

}  // namespace skincal
