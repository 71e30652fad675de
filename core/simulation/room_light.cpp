#include "core/simulation/room_light.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/geometry/random.h"

namespace skincal {
namespace {

constexpr double kFramesPerSecond = 30;
constexpr int kScreenCell_px = 10;

/// Share of a lamp's light that reaches each part of the picture: most of it about the lamp, some of it everywhere.
cv::Mat lampLight(const CameraModel& camera) {
    cv::Mat light(camera.height, camera.width, CV_32F);
    for (int y = 0; y < light.rows; ++y) {
        for (int x = 0; x < light.cols; ++x) {
            const double r = std::hypot(x - 0.25 * camera.width, y - 0.2 * camera.height) / (0.3 * camera.width);
            light.at<float>(y, x) = static_cast<float>(0.3 + 0.7 * std::exp(-0.5 * r * r));
        }
    }
    return light;
}

double smoothStep(double x) {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

RoomLight::RoomLight(const World& world, std::size_t view, std::size_t frames)
    : options_(world.scenario.disturbances), seed_(world.seed * 7907 + view), frames_(frames) {
    const CameraModel& camera = world.scenario.camera;
    if (options_.flicker > 0)
        lamp_ = lampLight(camera);
    Random random(seed_, "light of the room");
    darker_ = random.index(std::max<std::size_t>(1, frames / 2));
    lighter_ = darker_ + 1 + random.index(std::max<std::size_t>(2, frames / 2) - 1);
    if (options_.screen > 0) {
        const cv::Size size(camera.width / 4, camera.height / 4);
        screen_ = {cv::Point(static_cast<int>(random.index(static_cast<std::size_t>(camera.width - size.width))),
                             static_cast<int>(random.index(static_cast<std::size_t>(camera.height - size.height)))),
                   size};
    }
}

double RoomLight::sun(std::size_t frame) const {
    const double x = static_cast<double>(frame) / static_cast<double>(std::max<std::size_t>(1, frames_));
    // A cloud comes and goes within a tenth of the scan each.
    const double cloud = smoothStep((x - 0.35) / 0.1) - smoothStep((x - 0.6) / 0.1);
    return options_.sun * (x - 0.5 * cloud);
}

double RoomLight::exposure(std::size_t frame) const {
    return frame >= darker_ && frame < lighter_ ? 1 - options_.exposureStep : 1;
}

void RoomLight::showScreen(cv::Mat& light, const cv::Mat& roomShare, std::size_t frame) const {
    Random random(seed_ * 1000003 + frame, "screen");
    cv::Mat cells(screen_.height / kScreenCell_px, screen_.width / kScreenCell_px, CV_32F);
    for (int y = 0; y < cells.rows; ++y) {
        for (int x = 0; x < cells.cols; ++x)
            cells.at<float>(y, x) = static_cast<float>(options_.screen * random.uniform());
    }
    cv::Mat part = light(screen_);
    cv::Mat picture;
    cv::resize(cells, picture, screen_.size(), 0, 0, cv::INTER_LINEAR);
    part += picture.mul(roomShare(screen_));
}

void RoomLight::shine(cv::Mat& light, const cv::Mat& roomShare, std::size_t frame) const {
    if (options_.sun > 0)
        light *= 1 + sun(frame);
    if (!lamp_.empty()) {
        // At 100 Hz it beats at 10 Hz.
        const double phase =
            2 * 180 * kDegree * options_.flickerHz * static_cast<double>(frame) / kFramesPerSecond + 0.7;
        cv::scaleAdd(lamp_, options_.flicker * std::sin(phase), light, light);
    }
    if (!screen_.empty())
        showScreen(light, roomShare, frame);
}

}  // namespace skincal
