#include "core/camera_calibration/board_collector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace skincal {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kAngleOfOne_deg = 60;

double difference(const BoardPlacement& a, const BoardPlacement& b) {
    return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.size - b.size) +
           (std::abs(a.turn_deg - b.turn_deg) + std::abs(a.tilt_deg - b.tilt_deg)) / kAngleOfOne_deg;
}

/// 1 where `have` has come down from `from` to `to`.
double reached(double have, double from, double to) {
    return std::clamp((have - from) / (to - from), 0.0, 1.0);
}

}  // namespace

BoardPlacement placementOf(const BoardView& view, const BoardPlan& plan) {
    if (view.corners.size() < 4)
        throw std::logic_error("placementOf: at least 4 corners");
    std::vector<cv::Point2f> pixels;
    std::vector<cv::Point2f> places;
    for (const BoardCorner& corner : view.corners) {
        const Vector3d p = plan.corner(corner.id);
        pixels.emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
        places.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    }
    const cv::Rect2f box = cv::boundingRect(pixels);
    std::vector<cv::Point2f> hull;
    cv::convexHull(pixels, hull);
    const double width = view.size.width;
    const double height = view.size.height;
    BoardPlacement result;
    const auto share = [](double low, double length, double whole) {
        return whole > length ? std::clamp(low / (whole - length), 0.0, 1.0) : 0.5;
    };
    result.x = share(static_cast<double>(box.x), static_cast<double>(box.width), width);
    result.y = share(static_cast<double>(box.y), static_cast<double>(box.height), height);
    result.size = std::sqrt(cv::contourArea(hull) / (width * height));
    const cv::Mat homography = cv::findHomography(places, pixels);
    if (homography.empty())
        return result;
    const cv::Matx33d H = homography;
    const double f = std::max(width, height);
    const auto ray = [&](int column) {
        return Vector3d((H(0, column) - width / 2 * H(2, column)) / f, (H(1, column) - height / 2 * H(2, column)) / f,
                        H(2, column));
    };
    // H is K [r1 r2 t] up to scale, so r1 x r2 is the board's normal.
    Vector3d normal = ray(0).normalized().cross(ray(1).normalized());
    if (normal.z() < 0)
        normal = -normal;
    result.turn_deg = -std::atan2(normal.x(), normal.z()) * kDegrees;
    result.tilt_deg = -std::atan2(normal.y(), normal.z()) * kDegrees;
    return result;
}

bool BoardCollectorOptions::validate() const {
    return stillness_px > 0 && newness > 0 && gain > 0 && gridColumns > 0 && gridColumns <= 100 && gridRows > 0 &&
           gridRows <= 100 && views >= 3 && edge > 0 && edge < 0.5 && nearSize > 0 && nearSize < 1 && farSize > 0 &&
           farSize < 1 && angle_deg > 0 && angle_deg < 60 && coverage > 0 && coverage <= 1;
}

BoardCollector::BoardCollector(const BoardPlan& plan, const BoardCollectorOptions& options)
    : plan_(plan), options_(options) {
    if (!plan.validate() || !options.validate())
        throw std::logic_error("BoardCollector: plan or options out of range");
}

std::size_t BoardCollector::cellOf(const BoardView& view, const Vector2d& pixel) const {
    const auto cell = [](double at, int size, int count) {
        return std::clamp(static_cast<int>((at + 0.5) / size * count), 0, count - 1);
    };
    const int column = cell(pixel.x(), view.size.width, options_.gridColumns);
    const int row = cell(pixel.y(), view.size.height, options_.gridRows);
    return static_cast<std::size_t>(row * options_.gridColumns + column);
}

bool BoardCollector::isStill(const BoardView& view) const {
    if (!options_.mustBeStill)
        return true;
    if (!last_)
        return false;
    double sum = 0;
    std::size_t count = 0;
    auto other = last_->corners.begin();
    for (const BoardCorner& corner : view.corners) {
        while (other != last_->corners.end() && other->id < corner.id)
            ++other;
        if (other != last_->corners.end() && other->id == corner.id) {
            sum += (corner.pixel - other->pixel).squaredNorm();
            ++count;
        }
    }
    return count > 0 && sum <= options_.stillness_px * options_.stillness_px * static_cast<double>(count);
}

bool BoardCollector::isNew(const BoardView& view, const BoardPlacement& placement) const {
    double least = std::numeric_limits<double>::infinity();
    for (const BoardPlacement& kept : placements_)
        least = std::min(least, difference(kept, placement));
    if (views_.size() < static_cast<std::size_t>(options_.views))
        return least >= options_.newness;
    if (least < options_.newness / 2)
        return false;
    // With enough of them, only what brings the goal nearer: otherwise they'd be hundreds.
    BoardCollector with = *this;
    with.views_.push_back(view);
    with.placements_.push_back(placement);
    return with.missing().size() < missing().size() || with.progress() - progress() >= options_.gain;
}

OfferOutcome BoardCollector::offer(const BoardView& view) {
    if (!views_.empty() && views_.front().size != view.size)
        return OfferOutcome::OtherSize;
    const bool still = isStill(view);
    last_ = view;
    if (!still)
        return OfferOutcome::Moving;
    const BoardPlacement placement = placementOf(view, plan_);
    if (!isNew(view, placement))
        return OfferOutcome::Redundant;
    views_.push_back(view);
    placements_.push_back(placement);
    return OfferOutcome::Kept;
}

void BoardCollector::remove(std::size_t i) {
    if (i >= views_.size())
        throw std::logic_error("BoardCollector: no such view");
    views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(i));
    placements_.erase(placements_.begin() + static_cast<std::ptrdiff_t>(i));
}

void BoardCollector::takeBack(const BoardView& view) {
    if (!views_.empty() && views_.front().size != view.size)
        return;
    views_.push_back(view);
    placements_.push_back(placementOf(view, plan_));
}

std::vector<int> BoardCollector::coverage() const {
    std::vector<int> cells(static_cast<std::size_t>(options_.gridColumns * options_.gridRows), 0);
    for (const BoardView& view : views_) {
        for (const BoardCorner& corner : view.corners)
            ++cells[cellOf(view, corner.pixel)];
    }
    return cells;
}

double BoardCollector::coveredShare() const {
    const std::vector<int> cells = coverage();
    const auto empty = std::count(cells.begin(), cells.end(), 0);
    return 1 - static_cast<double>(empty) / static_cast<double>(cells.size());
}

std::vector<BoardCollector::Need> BoardCollector::needs() const {
    // Without views everything is as far away as can be.
    BoardPlacement low{1, 1, 1, 0, 0};
    BoardPlacement high{0, 0, 0, 0, 0};
    for (const BoardPlacement& p : placements_) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.size, p.size), 0, 0};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.size, p.size),
                std::max(high.turn_deg, std::abs(p.turn_deg)), std::max(high.tilt_deg, std::abs(p.tilt_deg))};
    }
    const double edge = options_.edge;
    const double count = static_cast<double>(views_.size());
    const double covered = coveredShare();
    return {
        {{BoardWish::LeftEdge, low.x, edge}, reached(low.x, 0.5, edge)},
        {{BoardWish::RightEdge, high.x, 1 - edge}, reached(high.x, 0.5, 1 - edge)},
        {{BoardWish::TopEdge, low.y, edge}, reached(low.y, 0.5, edge)},
        {{BoardWish::BottomEdge, high.y, 1 - edge}, reached(high.y, 0.5, 1 - edge)},
        {{BoardWish::Turn, high.turn_deg, options_.angle_deg}, reached(high.turn_deg, 0, options_.angle_deg)},
        {{BoardWish::Tilt, high.tilt_deg, options_.angle_deg}, reached(high.tilt_deg, 0, options_.angle_deg)},
        {{BoardWish::Nearer, high.size, options_.nearSize}, reached(high.size, 0, options_.nearSize)},
        {{BoardWish::Farther, low.size, options_.farSize}, reached(low.size, 1, options_.farSize)},
        {{BoardWish::FillCells, covered, options_.coverage}, reached(covered, 0, options_.coverage)},
        {{BoardWish::MoreViews, count, static_cast<double>(options_.views)}, reached(count, 0, options_.views)},
    };
}

std::vector<MissingView> BoardCollector::missing() const {
    std::vector<MissingView> result;
    for (const Need& need : needs()) {
        if (need.reached < 1)
            result.push_back(need.numbers);
    }
    return result;
}

double BoardCollector::progress() const {
    double sum = 0;
    const std::vector<Need> all = needs();
    for (const Need& need : all)
        sum += need.reached;
    return sum / static_cast<double>(all.size());
}

}  // namespace skincal
