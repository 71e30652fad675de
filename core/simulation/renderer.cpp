#include "core/simulation/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/geometry/random.h"
#include "core/simulation/mirror.h"

namespace skincal {
namespace {

constexpr std::size_t kNoiseTable = std::size_t{1} << 16U;
constexpr std::array<double, 3> kWarmLight{0.88, 1.0, 1.07};  // BGR, of the room in colour pictures
constexpr double kReferenceDistance = 0.6;                    // m, at which RenderOptions::ledPeak holds

double peakTowards(const World& world, std::size_t module, const Vector3d& camera_r) {
    const RenderOptions& options = world.scenario.pictures;
    const Vector3d ray = camera_r - world.T_r_u[module] * world.trueTemplate(module).led;
    const double angle = std::acos(std::clamp(world.T_r_u[module].linear().col(2).dot(ray.normalized()), -1.0, 1.0));
    return options.ledPeak * ledLobe(angle, options.lobe) * std::pow(kReferenceDistance / ray.norm(), 2);
}

}  // namespace

Matrix3d bumpOf(const Scenario& scenario) {
    return so3Exp(scenario.disturbances.bump_px / scenario.camera.fx * Vector3d(0.6, -0.8, 0.1));
}

Visibility visibilityOfLight() {
    Visibility visibility;
    visibility.maxAngle = 85 * kDegree;
    visibility.margin_px = -20;
    return visibility;
}

double ledLobe(double angle, double fullAngle) {
    const double c = std::cos(angle);
    if (c <= 0)
        return 0;
    return std::pow(c, std::log(0.5) / std::log(std::cos(0.5 * fullAngle)));
}

void drawLed(cv::Mat& light, const LedSpot& spot, const RenderOptions& options) {
    constexpr double kHaloWidth = 2.5;
    const int radius = static_cast<int>(std::ceil(3.5 * kHaloWidth * options.blur_px));
    const int cx = static_cast<int>(std::lround(spot.pixel.x()));
    const int cy = static_cast<int>(std::lround(spot.pixel.y()));
    for (const auto& [width, peak] :
         {std::pair(options.blur_px, spot.peak), std::pair(kHaloWidth * options.blur_px, options.halo * spot.peak)}) {
        // A pixel collects light over its area: differences of the error function, exact at any sub-pixel place.
        const double s = 1 / (std::sqrt(2.0) * width);
        const double norm = 2 * 180 * kDegree * width * width * peak / 4;
        std::vector<double> along(static_cast<std::size_t>(2 * radius + 1));
        for (int dx = -radius; dx <= radius; ++dx) {
            const double x = cx + dx - spot.pixel.x();
            along[static_cast<std::size_t>(dx + radius)] = std::erf((x + 0.5) * s) - std::erf((x - 0.5) * s);
        }
        for (int dy = -radius; dy <= radius; ++dy) {
            const int y = cy + dy;
            if (y < 0 || y >= light.rows)
                continue;
            const double v = y - spot.pixel.y();
            const double across = norm * (std::erf((v + 0.5) * s) - std::erf((v - 0.5) * s));
            auto* row = light.ptr<float>(y);
            for (int dx = std::max(-radius, -cx); dx <= std::min(radius, light.cols - 1 - cx); ++dx)
                row[cx + dx] += static_cast<float>(across * along[static_cast<std::size_t>(dx + radius)]);
        }
    }
}

FrameRenderer::FrameRenderer(const World& world, std::size_t view, std::size_t frames)
    : FrameRenderer(world, world.T_r_v[view], view, frames) {}

FrameRenderer::FrameRenderer(const World& world, const Isometry3d& T_r_v, std::size_t view, std::size_t frames)
    : world_(world),
      T_r_v_(T_r_v),
      view_(view),
      frames_(frames),
      // The same whether the camera will be knocked or not, so that the first half of such a view is as it was.
      margin_(std::max(32, 4 + static_cast<int>(std::ceil(2 * world.scenario.disturbances.bump_px)))),
      painter_(world, view, margin_),
      roomLight_(world, view, frames),
      noise_(kNoiseTable),
      index_(world.skin.indexById()) {
    Random random(world.seed, "noise table");
    for (float& n : noise_)
        n = static_cast<float>(random.normal());
    if (world.scenario.disturbances.person)
        person_ = paintPerson(world.scenario.camera, world.scenario.pictures);
    moveCamera(T_r_v);
}

void FrameRenderer::moveCamera(const Isometry3d& T_r_v) {
    const DisturbanceOptions& disturbances = world_.scenario.disturbances;
    const CameraModel& camera = world_.scenario.camera;
    T_r_v_ = T_r_v;
    const cv::Mat scene = painter_.paint(T_r_v);
    background_ = scene(cv::Rect(margin_, margin_, camera.width, camera.height)).clone();
    roomShare_ = painter_.roomShare()(cv::Rect(margin_, margin_, camera.width, camera.height)).clone();
    spots_ = spotsAt(T_r_v);
    images_ = imagesAt(T_r_v);
    if (disturbances.bump_px > 0 && view_ % 2 == 1) {
        const Matrix3d R_v_b = bumpOf(world_.scenario);
        bumpedBackground_ = turnScene(scene, camera, R_v_b);
        const Isometry3d T_r_b = makeIsometry(T_r_v.linear() * R_v_b, T_r_v.translation());
        bumpedSpots_ = spotsAt(T_r_b);
        bumpedImages_ = imagesAt(T_r_b);
    }
}

std::vector<LedSpot> FrameRenderer::spotsAt(const Isometry3d& T_r_v) const {
    std::vector<LedSpot> spots(world_.T_r_u.size());
    for (std::size_t u = 0; u < spots.size(); ++u) {
        if (!visiblePixel(world_, T_r_v_, view_, u, visibilityOfLight()))
            continue;
        const Vector3d led_r = world_.T_r_u[u] * world_.trueTemplate(u).led;
        if (const auto pixel = world_.scenario.camera.project(T_r_v.inverse() * led_r))
            spots[u] = {*pixel, peakTowards(world_, u, T_r_v.translation())};
    }
    return spots;
}

std::vector<LedSpot> FrameRenderer::imagesAt(const Isometry3d& T_r_v) const {
    const double share = world_.scenario.disturbances.reflection;
    if (share <= 0)
        return {};
    const Mirror mirror(world_, T_r_v_);
    std::vector<LedSpot> images(world_.T_r_u.size());
    for (std::size_t u = 0; u < images.size(); ++u) {
        if (const auto pixel = mirror.pixelOf(T_r_v, view_, u, visibilityOfLight().maxAngle))
            images[u] = {*pixel, share * peakTowards(world_, u, mirror.image())};
    }
    return images;
}

bool FrameRenderer::bumped(std::size_t frame) const {
    return !bumpedSpots_.empty() && 2 * frame >= frames_;
}

void FrameRenderer::passBy(cv::Mat& light, std::size_t frame) const {
    // At a walk: 1.2 m/s where shoulders of half a metre are an eighth of the picture wide, at 30 frames per second.
    // From view to view he has come nearer, is in the middle, leaves.
    constexpr double kPace = 0.03;  // picture widths per frame
    const double way = -0.25 + 0.3 * static_cast<double>(view_ % 4) + kPace * static_cast<double>(frame);
    const int left = static_cast<int>(std::lround(way * light.cols)) - person_.level.cols / 2;
    const cv::Rect place(left, 0, person_.level.cols, person_.level.rows);
    const cv::Rect inside = place & cv::Rect(0, 0, light.cols, light.rows);
    if (inside.empty())
        return;
    const cv::Rect part(inside.x - left, 0, inside.width, inside.height);
    for (int y = 0; y < inside.height; ++y) {
        const auto* level = person_.level.ptr<float>(y) + part.x;
        const auto* cover = person_.cover.ptr<float>(y) + part.x;
        auto* row = light.ptr<float>(y) + inside.x;
        for (int x = 0; x < inside.width; ++x)
            row[x] += cover[x] * (level[x] - row[x]);
    }
}

cv::Mat FrameRenderer::expose(const cv::Mat& light, std::uint64_t noiseSeed) const {
    const RenderOptions& options = world_.scenario.pictures;
    // Standard deviation by grey level: read and shot noise together.
    std::array<float, 257> sigma{};
    for (std::size_t level = 0; level < sigma.size(); ++level)
        sigma.at(level) = static_cast<float>(
            std::sqrt(options.readNoise * options.readNoise + options.shotNoise * static_cast<double>(level)));
    Random random(noiseSeed);
    cv::Mat picture(light.size(), CV_8UC1);
    const auto columns = static_cast<std::size_t>(light.cols);
    for (int y = 0; y < light.rows; ++y) {
        // Each row reads the table from a place of its own: cheap, and nothing repeats that anyone would look for.
        const float* noise = noise_.data() + random.index(kNoiseTable - columns);
        const auto* in = light.ptr<float>(y);
        auto* out = picture.ptr<unsigned char>(y);
        for (std::size_t x = 0; x < columns; ++x) {
            const float level = std::min(255.0F, std::max(0.0F, in[x]));
            const float value = in[x] + sigma[static_cast<std::size_t>(level)] * noise[x] + 0.5F;
            out[x] = static_cast<unsigned char>(std::min(255.0F, std::max(0.0F, value)));
        }
    }
    return picture;
}

void FrameRenderer::drawLit(cv::Mat& light, const std::vector<LitModule>& lit, std::size_t frame, int channel) const {
    for (const LitModule& l : lit) {
        const auto found = index_.find(l.module);
        if (found == index_.end())
            continue;
        for (const auto* all : {bumped(frame) ? &bumpedSpots_ : &spots_, bumped(frame) ? &bumpedImages_ : &images_}) {
            LedSpot spot = all->empty() ? LedSpot() : (*all)[found->second];
            if (spot.peak <= 0)
                continue;
            if (l.colour) {
                // BGR; a coloured LED leaks a little into the other channels of the sensor.
                const int on = l.colour->at(static_cast<std::size_t>(2 - channel));
                spot.peak *= on != 0 ? 1.0 : 0.08;
            }
            drawLed(light, spot, world_.scenario.pictures);
        }
    }
}

cv::Mat FrameRenderer::render(const std::vector<LitModule>& lit, std::size_t frame, bool colour, double exposure,
                              const HeldLayer& held) const {
    colour = colour || std::any_of(lit.begin(), lit.end(), [](const LitModule& l) { return l.colour.has_value(); });
    const std::uint64_t frameSeed = (world_.seed * 1000003 + view_) * 1000003 + frame;
    std::vector<cv::Mat> channels;
    for (int channel = 0; channel < (colour ? 3 : 1); ++channel) {
        cv::Mat light = (bumped(frame) ? bumpedBackground_ : background_).clone();
        if (colour)
            light *= kWarmLight.at(static_cast<std::size_t>(channel));
        roomLight_.shine(light, roomShare_, frame);
        drawLit(light, lit, frame, channel);
        if (!held.cover.empty()) {
            cv::Mat behind = light(cv::Rect(held.corner, held.cover.size()));
            const double tint = colour ? kWarmLight.at(static_cast<std::size_t>(channel)) : 1;
            behind = behind.mul(1 - held.cover) + tint * held.light;
        }
        // Who stands in front hides LEDs as he hides everything else.
        if (!person_.level.empty())
            passBy(light, frame);
        if (const double share = exposure * roomLight_.exposure(frame); share != 1)
            light *= share;
        channels.push_back(expose(light, frameSeed * 3 + static_cast<std::uint64_t>(channel)));
    }
    if (!colour)
        return channels.front();
    cv::Mat picture;
    cv::merge(channels, picture);
    return picture;
}

}  // namespace skincal
