#include "tests/unit/camera_calibration/board_painter.h"

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace skincal::test {
namespace {

/// The board seen from above, 0 or 255, and how many of its pixels a metre has.
struct Sheet {
    cv::Mat picture;
    double scale;
};

Sheet sheetOf(const BoardPlan& plan) {
    constexpr double kPixelsOfSquare = 120;
    const double scale = kPixelsOfSquare / plan.square;
    cv::Mat picture(static_cast<int>(std::lround(plan.height() * scale)),
                    static_cast<int>(std::lround(plan.width() * scale)), CV_8U, cv::Scalar(255));
    for (const BoardCell& cell : blackCells(plan)) {
        const auto at = [&](double v) { return static_cast<int>(std::lround(v * scale)); };
        picture(cv::Range(at(cell.y), at(cell.y + cell.height)), cv::Range(at(cell.x), at(cell.x + cell.width)))
            .setTo(0);
    }
    return {picture, scale};
}

}  // namespace

cv::Mat paintBoard(const CameraModel& camera, const BoardPlan& plan, const Eigen::Isometry3d& T_v_b,
                   const PaintOptions& options) {
    constexpr double kRoom = 110;
    constexpr double kPaper = 205;
    constexpr double kInk = 35;
    const Sheet sheet = sheetOf(plan);
    const Eigen::Isometry3d T_b_v = T_v_b.inverse();
    const double margin = 0.4 * plan.square;
    cv::Mat picture(camera.height, camera.width, CV_32F);
    const auto brightness = [&](const Vector2d& ray) {
        const Vector3d direction = T_b_v.linear() * Vector3d(ray.x(), ray.y(), 1);
        const Vector3d origin = T_b_v.translation();
        const double s = -origin.z() / direction.z();
        const Vector3d p = origin + s * direction;
        if (!(s > 0) || p.x() < -margin || p.y() < -margin || p.x() > plan.width() + margin ||
            p.y() > plan.height() + margin)
            return kRoom;
        const int u = static_cast<int>(std::floor(p.x() * sheet.scale));
        const int v = static_cast<int>(std::floor(p.y() * sheet.scale));
        const bool inside = u >= 0 && v >= 0 && u < sheet.picture.cols && v < sheet.picture.rows;
        return inside && sheet.picture.at<std::uint8_t>(v, u) == 0 ? kInk : kPaper;
    };
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            // Within a pixel the camera is as good as linear.
            const Vector2d at = camera.unproject({x, y});
            const Vector2d dx = camera.unproject({x + 0.5, y}) - at;
            const Vector2d dy = camera.unproject({x, y + 0.5}) - at;
            double sum = 0;
            for (int j = 0; j < options.samples; ++j) {
                for (int i = 0; i < options.samples; ++i)
                    sum += brightness(at + dx * ((2 * i + 1.0) / options.samples - 1) +
                                      dy * ((2 * j + 1.0) / options.samples - 1));
            }
            picture.at<float>(y, x) = static_cast<float>(sum / (options.samples * options.samples));
        }
    }
    if (options.blur_px > 0)
        cv::GaussianBlur(picture, picture, {}, options.blur_px);
    Random random(options.seed, "board noise");
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x)
            picture.at<float>(y, x) += static_cast<float>(options.noise * random.normal());
    }
    cv::Mat result;
    picture.convertTo(result, CV_8U);
    return result;
}

BoardView seeBoard(const CameraModel& camera, const BoardPlan& plan, const Eigen::Isometry3d& T_v_b, Random& random,
                   double sigma_px) {
    BoardView view;
    view.size = {camera.width, camera.height};
    for (int id = 0; id < plan.cornerCount(); ++id) {
        const auto pixel = camera.project(T_v_b * plan.corner(id));
        if (pixel && camera.contains(*pixel))
            view.corners.push_back({id, *pixel + sigma_px * Vector2d(random.normal(), random.normal())});
    }
    return view;
}

Eigen::Isometry3d randomPose(const CameraModel& camera, const BoardPlan& plan, Random& random, double maxTilt_deg) {
    const Vector2d pixel(random.uniform(0.25, 0.75) * camera.width, random.uniform(0.25, 0.75) * camera.height);
    const Vector2d ray = camera.unproject(pixel);
    const double depth = random.uniform(1.3, 2.4) * plan.width() * camera.fx / camera.width;
    const double tilt = random.uniform(0, maxTilt_deg) * std::numbers::pi / 180;
    const double axis = random.uniform(0, 2 * std::numbers::pi);
    const Matrix3d R =
        so3Exp(tilt * Vector3d(std::cos(axis), std::sin(axis), 0)) * so3Exp(Vector3d(0, 0, random.uniform(-0.5, 0.5)));
    const Vector3d middle(plan.width() / 2, plan.height() / 2, 0);
    return makeIsometry(R, depth * Vector3d(ray.x(), ray.y(), 1) - R * middle);
}

}  // namespace skincal::test
