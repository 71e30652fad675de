#include "core/rig/board_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/rig/held_board.h"

namespace skincal {
namespace {

constexpr int kGrid = 8;             // px
constexpr double kSheetPixels = 64;  // of a square; makes kPaper whole pixels, so that squares are where they are
constexpr unsigned char kPaperLevel = 205;
constexpr unsigned char kInkLevel = 35;

/// Where in a pixel each ray goes: no two in the same sixteenth of its width or height, so that edges that lie along
/// rows or columns are as exact as others.
std::array<Vector2d, BoardPainter::kSamples> places() {
    std::array<Vector2d, BoardPainter::kSamples> result;
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i)
            result.at(static_cast<std::size_t>(4 * j + i)) = {(i + (j + 0.5) / 4) / 4 - 0.5,
                                                              (j + (i + 0.5) / 4) / 4 - 0.5};
    }
    return result;
}

/// From rays to pixels of the sheet, up to scale: the board's plane is z_b = 0, so p_b = R (s ray) + t, third row 0.
Matrix3d sheetFromRay(const BoardPlan& plan, const Isometry3d& T_v_b) {
    const Isometry3d T_b_v = T_v_b.inverse();
    const Matrix3d& R = T_b_v.linear();
    const Vector3d& t = T_b_v.translation();
    Matrix3d H;
    // x = (R0 s + t0) with s = -t2 / (R2 ray): times R2 ray, which is the third row.
    H.row(0) = t.x() * R.row(2) - t.z() * R.row(0);
    H.row(1) = t.y() * R.row(2) - t.z() * R.row(1);
    H.row(2) = R.row(2);
    const double scale = kSheetPixels / plan.square;
    const double paper = HeldBoard::kPaper * kSheetPixels;
    Matrix3d S;
    S << scale, 0, paper, 0, scale, paper, 0, 0, 1;
    return S * H;
}

}  // namespace

BoardPainter::BoardPainter(const CameraModel& camera, double blur_px)
    : camera_(camera), blur_px_(blur_px), rays_(camera.height / kGrid + 2, camera.width / kGrid + 2, CV_64FC2) {
    for (int row = 0; row < rays_.rows; ++row) {
        for (int column = 0; column < rays_.cols; ++column) {
            const Vector2d ray = camera.unproject({kGrid * column, kGrid * row});
            rays_.at<cv::Vec2d>(row, column) = {ray.x(), ray.y()};
        }
    }
}

Vector2d BoardPainter::rayAt(int column, int row) const {
    const auto& ray = rays_.at<cv::Vec2d>(row, column);
    return {ray[0], ray[1]};
}

void BoardPainter::print(const BoardPlan& plan) {
    if (!sheet_.empty() && isSameBoard(plan, plan_))
        return;
    plan_ = plan;
    const double scale = kSheetPixels / plan.square;
    const double paper = HeldBoard::kPaper * kSheetPixels;
    const auto at = [&](double v) { return static_cast<int>(std::lround(paper + v * scale)); };
    sheet_.create(at(plan.height() + HeldBoard::kPaper * plan.square),
                  at(plan.width() + HeldBoard::kPaper * plan.square), CV_8U);
    sheet_.setTo(kPaperLevel);
    for (const BoardCell& cell : blackCells(plan))
        sheet_(cv::Range(at(cell.y), at(cell.y + cell.height)), cv::Range(at(cell.x), at(cell.x + cell.width)))
            .setTo(kInkLevel);
}

cv::Rect BoardPainter::boxOf(std::span<const Isometry3d> T_v_b) const {
    // Edges are bent by the lens: a little more than the corners' box.
    const double margin = HeldBoard::kPaper * plan_.square;
    const int more = 8 + static_cast<int>(std::ceil(3 * blur_px_));
    cv::Rect box;
    for (const Isometry3d& T : T_v_b) {
        for (const double x : {-margin, 0.5 * plan_.width(), plan_.width() + margin}) {
            for (const double y : {-margin, 0.5 * plan_.height(), plan_.height() + margin}) {
                const auto pixel = camera_.project(T * Vector3d(x, y, 0));
                if (!pixel || pixel->cwiseAbs().maxCoeff() > 1e5)
                    return {0, 0, camera_.width, camera_.height};
                const cv::Rect point(cvRound(pixel->x()) - more, cvRound(pixel->y()) - more, 2 * more, 2 * more);
                box = box.empty() ? point : box | point;
            }
        }
    }
    return box & cv::Rect(0, 0, camera_.width, camera_.height);
}

HeldLayer BoardPainter::paint(const BoardPlan& plan, std::span<const Isometry3d> T_v_b) {
    if (T_v_b.size() != 1 && T_v_b.size() != kSamples)
        throw std::logic_error("BoardPainter: one pose or kSamples");
    print(plan);
    const cv::Rect box = boxOf(T_v_b);
    if (box.empty())
        return {};
    static const std::array<Vector2d, kSamples> kWhere = places();
    std::array<Matrix3d, kSamples> H;
    for (std::size_t k = 0; k < kSamples; ++k)
        // Moments go through the pixel by leaps: its left part is not all of the beginning.
        H.at(k) = sheetFromRay(plan, T_v_b[T_v_b.size() == 1 ? 0 : (7 * k) % kSamples]);
    HeldLayer layer{cv::Mat(box.size(), CV_32F), cv::Mat(box.size(), CV_32F), box.tl()};
    for (int y = box.y; y < box.y + box.height; ++y) {
        auto* light = layer.light.ptr<float>(y - box.y);
        auto* cover = layer.cover.ptr<float>(y - box.y);
        const int row = y / kGrid;
        const double b = (y - row * kGrid) / static_cast<double>(kGrid);
        for (int x = box.x; x < box.x + box.width; ++x) {
            const int column = x / kGrid;
            const double a = (x - column * kGrid) / static_cast<double>(kGrid);
            const Vector2d p00 = rayAt(column, row), p10 = rayAt(column + 1, row);
            const Vector2d p01 = rayAt(column, row + 1), p11 = rayAt(column + 1, row + 1);
            const Vector2d upper = p00 + a * (p10 - p00);
            const Vector2d lower = p01 + a * (p11 - p01);
            const Vector2d ray = upper + b * (lower - upper);
            const Vector2d right = ((1 - b) * (p10 - p00) + b * (p11 - p01)) / kGrid;
            const Vector2d down = (lower - upper) / kGrid;
            int sum = 0;
            int hits = 0;
            for (std::size_t k = 0; k < kSamples; ++k) {
                const Vector2d& where = kWhere[k];
                const double u = ray.x() + where.x() * right.x() + where.y() * down.x();
                const double v = ray.y() + where.x() * right.y() + where.y() * down.y();
                const Matrix3d& h = H[k];
                const double w = 1 / (h(2, 0) * u + h(2, 1) * v + h(2, 2));
                const double sx = (h(0, 0) * u + h(0, 1) * v + h(0, 2)) * w;
                const double sy = (h(1, 0) * u + h(1, 1) * v + h(1, 2)) * w;
                if (sx >= 0 && sy >= 0 && sx < sheet_.cols && sy < sheet_.rows) {
                    sum += sheet_.ptr<unsigned char>(static_cast<int>(sy))[static_cast<int>(sx)];
                    ++hits;
                }
            }
            light[x - box.x] = static_cast<float>(sum) / kSamples;
            cover[x - box.x] = static_cast<float>(hits) / kSamples;
        }
    }
    if (blur_px_ > 0) {
        cv::GaussianBlur(layer.light, layer.light, {}, blur_px_, blur_px_, cv::BORDER_REPLICATE);
        cv::GaussianBlur(layer.cover, layer.cover, {}, blur_px_, blur_px_, cv::BORDER_REPLICATE);
    }
    return layer;
}

}  // namespace skincal
