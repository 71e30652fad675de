#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/camera_calibration/calibrate_camera.h"

namespace skincal {
namespace {

using Kind = CalibrationReason::Kind;

/// A measure and where it stops being good and being usable.
struct Limit {
    Kind kind;
    double good;
    double usable;
    bool smallerIsBetter;
};

constexpr Limit kFewBoards{Kind::FewBoards, 10, 6, false};
constexpr Limit kCoverage{Kind::PoorCoverage, 0.6, 0.3, false};
constexpr Limit kTilt{Kind::LittleTilt, 25, 10, false};
constexpr Limit kResiduals{Kind::LargeResiduals, 0.5, 1.5, true};
constexpr Limit kFocal{Kind::FocalUncertain, 0.003, 0.02, true};
constexpr Limit kCentre{Kind::CentreUncertain, 0.003, 0.02, true};
constexpr Limit kRejected{Kind::ManyRejected, 0.2, 0.5, true};

void hold(const Limit& limit, double found, std::vector<CalibrationReason>& reasons) {
    const auto meets = [&](double needed) { return limit.smallerIsBetter ? found <= needed : found >= needed; };
    if (meets(limit.good))
        return;
    const bool usable = meets(limit.usable);
    reasons.push_back({limit.kind, usable ? CalibrationTrust::Usable : CalibrationTrust::NotToBeTrusted, found,
                       usable ? limit.good : limit.usable});
}

double coverageOf(std::span<const BoardView> views, const CameraCalibration& calibration) {
    constexpr int kColumns = 8;
    constexpr int kRows = 6;
    std::set<int> cells;
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (!calibration.boards[i].used)
            continue;
        for (const BoardCorner& corner : views[i].corners) {
            const auto cell = [](double at, int size, int count) {
                return std::clamp(static_cast<int>((at + 0.5) / size * count), 0, count - 1);
            };
            cells.insert(cell(corner.pixel.y(), views[i].size.height, kRows) * kColumns +
                         cell(corner.pixel.x(), views[i].size.width, kColumns));
        }
    }
    return static_cast<double>(cells.size()) / (kColumns * kRows);
}

double largestAngle_deg(const CameraCalibration& calibration) {
    double smallest = 1;
    for (const CalibratedBoard& a : calibration.boards) {
        for (const CalibratedBoard& b : calibration.boards) {
            if (a.used && b.used)
                smallest = std::min(smallest, a.T_v_b.linear().col(2).dot(b.T_v_b.linear().col(2)));
        }
    }
    return std::acos(std::clamp(smallest, -1.0, 1.0)) * 180 / std::numbers::pi;
}

/// How far from the centre, as a share of the way to the picture's corner, pixels still have directions of their own;
/// 1 where all of them have.
double foldsAt(const CameraModel& camera) {
    double least = 1;
    for (const double x : {-0.5, camera.width - 0.5}) {
        for (const double y : {-0.5, camera.height - 0.5}) {
            const Vector2d centre(camera.cx, camera.cy);
            const Vector2d way = Vector2d(x, y) - centre;
            double before = 0;
            for (double share = 0.02; share <= 1; share += 0.02) {
                const Vector2d pixel = centre + share * way;
                const Vector2d ray = camera.unproject(pixel);
                const auto back = camera.project({ray.x(), ray.y(), 1});
                if (!back || (*back - pixel).norm() > 1e-3 || !(ray.norm() > before)) {
                    least = std::min(least, share);
                    break;
                }
                before = ray.norm();
            }
        }
    }
    return least;
}

}  // namespace

void judgeCalibration(std::span<const BoardView> views, CameraCalibration& calibration) {
    std::vector<CalibrationReason> reasons;
    const auto count = static_cast<double>(calibration.boards.size());
    const auto rejected = static_cast<double>(calibration.rejected.size());
    const CameraModel& camera = calibration.camera;
    hold(kFewBoards, count - rejected, reasons);
    hold(kCoverage, coverageOf(views, calibration), reasons);
    hold(kTilt, largestAngle_deg(calibration), reasons);
    hold(kResiduals, calibration.rms_px, reasons);
    hold(kRejected, count > 0 ? rejected / count : 0, reasons);
    if (calibration.sigma) {
        const IntrinsicsSigma& sigma = *calibration.sigma;
        hold(kFocal, std::max(sigma.fx / camera.fx, sigma.fy / camera.fy), reasons);
        hold(kCentre, std::max(sigma.cx, sigma.cy) / camera.width, reasons);
    } else {
        reasons.push_back({Kind::NotDetermined, CalibrationTrust::NotToBeTrusted, 0, 0});
    }
    if (const double share = foldsAt(camera); share < 1)
        reasons.push_back({Kind::FoldsBack, CalibrationTrust::NotToBeTrusted, share, 1});
    std::stable_sort(reasons.begin(), reasons.end(), [](const auto& a, const auto& b) { return a.trust > b.trust; });
    calibration.trust = reasons.empty() ? CalibrationTrust::Good : reasons.front().trust;
    calibration.reasons = std::move(reasons);
}

}  // namespace skincal
