#include "core/simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/geometry/random.h"
#include "core/simulation/body_polygons.h"

namespace skincal {
namespace {

constexpr int kFine = 2;  // edges are drawn this much finer than pixels, then averaged

double levelOf(const RenderOptions& options, double brightness) {
    constexpr double kFullTexture = 45;
    return options.background * std::max(0.05, 1 + options.texture / kFullTexture * (brightness - 1));
}

cv::Mat clouds(cv::Size size, cv::Size grain, Random& random) {
    cv::Mat coarse(grain, CV_32F);
    for (int y = 0; y < coarse.rows; ++y) {
        for (int x = 0; x < coarse.cols; ++x)
            coarse.at<float>(y, x) = static_cast<float>(random.normal());
    }
    cv::Mat fine;
    cv::resize(coarse, fine, size, 0, 0, cv::INTER_CUBIC);
    return fine;
}

/// Wall, shelf with books, a screen and a table, behind what the camera is focused on.
cv::Mat paintRoom(const World& world, std::size_t view, cv::Size size) {
    const RenderOptions& options = world.scenario.pictures;
    Random random(world.seed + 7919 * view, "background");
    const auto fill = [&](cv::Mat& picture, double x, double y, double width, double height, double brightness) {
        const cv::Rect area(
            static_cast<int>(std::lround(x * size.width)), static_cast<int>(std::lround(y * size.height)),
            static_cast<int>(std::lround(width * size.width)), static_cast<int>(std::lround(height * size.height)));
        cv::rectangle(picture, area, cv::Scalar(brightness), cv::FILLED);
    };
    cv::Mat room = 1 + 0.10 * clouds(size, cv::Size(5, 4), random);
    const double shelf = random.uniform(0.05, 0.2);
    const double first = random.uniform(-0.1, 0.5);
    for (int row = 0; row < 2; ++row) {
        const double bottom = shelf + 0.19 * (row + 1);
        fill(room, first, bottom - 0.17, 0.45, 0.17, 0.55);
        for (double x = first + 0.005; x < first + 0.44;) {
            const double width = random.uniform(0.008, 0.03);
            const double height = random.uniform(0.09, 0.15);
            if (random.uniform() < 0.85)
                fill(room, x, bottom - height, width - 0.002, height, random.uniform(0.4, 1.7));
            x += width;
        }
        fill(room, first - 0.01, bottom, 0.47, 0.02, 1.3);
    }
    const double screen = first < 0.2 ? random.uniform(0.6, 0.75) : random.uniform(0.02, 0.15);
    const double top = random.uniform(0.15, 0.35);
    fill(room, screen, top, 0.24, 0.26, 0.3);
    fill(room, screen + 0.008, top + 0.014, 0.224, 0.225, 1.35);
    fill(room, screen + 0.10, top + 0.26, 0.03, 0.2, 0.35);

    // The table runs to the picture's lower edge; its grain is fine along one direction.
    const double edge = random.uniform(0.62, 0.74);
    const double slope = random.uniform(-0.03, 0.03);
    cv::Mat wood = 1.2 + 0.06 * clouds(size, cv::Size(6, 120), random) + 0.05 * clouds(size, cv::Size(4, 4), random);
    cv::Mat mask = cv::Mat::zeros(size, CV_8U);
    const std::vector<cv::Point> table{{0, static_cast<int>((edge - slope) * size.height)},
                                       {size.width, static_cast<int>((edge + slope) * size.height)},
                                       {size.width, size.height},
                                       {0, size.height}};
    cv::fillConvexPoly(mask, table, cv::Scalar(255));
    wood.copyTo(room, mask);
    for (int box = 0; box < 3; ++box)
        fill(room, random.uniform(0, 0.9), edge - random.uniform(0.03, 0.12), random.uniform(0.03, 0.1), 0.15,
             random.uniform(0.5, 1.4));
    cv::GaussianBlur(room, room, cv::Size(0, 0), 2.5);
    constexpr double kFullTexture = 45;
    room = options.background * (1 + options.texture / kFullTexture * (room - 1));
    return cv::max(room, 3.0);
}

/// Draws over `fine` and marks in `covered` what was drawn on.
/// @return a box round it, within the picture
cv::Rect drawGroup(const PolygonGroup& group, const World& world, int margin, cv::Mat& fine, cv::Mat& covered) {
    constexpr int kShift = 4;
    constexpr int kUnit = 1 << kShift;
    constexpr double kUnits = kUnit;
    cv::Rect drawn;
    for (const PolygonGroup::Polygon& polygon : group.polygons) {
        std::vector<cv::Point> corners;
        for (const Vector3d& p : polygon.corners) {
            // Far outside the picture a lens model says nothing.
            const auto pixel = p.head<2>().norm() < p.z() ? world.scenario.camera.project(p) : std::nullopt;
            if (!pixel)
                break;
            const Vector2d place = kFine * (*pixel + Vector2d::Constant(margin + 0.5)) - Vector2d::Constant(0.5);
            corners.emplace_back(static_cast<int>(std::lround(kUnits * place.x())),
                                 static_cast<int>(std::lround(kUnits * place.y())));
        }
        if (corners.size() < polygon.corners.size())
            continue;
        cv::fillConvexPoly(fine, corners, cv::Scalar(levelOf(world.scenario.pictures, polygon.brightness)), cv::LINE_8,
                           kShift);
        cv::fillConvexPoly(covered, corners, cv::Scalar(1.0), cv::LINE_8, kShift);
        const cv::Rect box = cv::boundingRect(corners);
        drawn |= cv::Rect(cv::Point(box.x / kUnit - 2, box.y / kUnit - 2),
                          cv::Point(box.br().x / kUnit + 2, box.br().y / kUnit + 2));
    }
    return drawn & cv::Rect({0, 0}, fine.size());
}

/// The room with the body seen once more, upside down, in a polished surface in front of it.
void paintMirror(const World& world, int margin, const cv::Mat& body, const cv::Mat& covered, cv::Mat& scene) {
    const double share = world.scenario.disturbances.reflection;
    const double edge = mirrorEdge(world.scenario.camera) + margin;
    for (int y = static_cast<int>(std::ceil(edge)); y < scene.rows; ++y) {
        const int above = static_cast<int>(std::lround(2 * edge)) - y;
        if (above < 0)
            break;
        const cv::Mat image =
            share * body.row(above).mul(covered.row(above)) + scene.row(y).mul(1 - share * covered.row(above));
        image.copyTo(scene.row(y));
    }
}

/// A cardboard box that somebody left in front of the camera.
void paintOccluder(const World& world, const Isometry3d& T_r_v, std::size_t view, int margin, cv::Mat& scene) {
    const Eigen::Vector4d hidden = occluderOf(world, T_r_v, view);
    if (hidden[2] <= 0)
        return;
    const auto area = [&](double x, double y, double width, double height) {
        return cv::Rect(static_cast<int>(std::lround(hidden[0] + x * hidden[2])) + margin,
                        static_cast<int>(std::lround(hidden[1] + y * hidden[3])) + margin,
                        static_cast<int>(std::lround(width * hidden[2])),
                        static_cast<int>(std::lround(height * hidden[3])));
    };
    const auto paint = [&](const cv::Rect& where, double brightness) {
        cv::rectangle(scene, where, cv::Scalar(levelOf(world.scenario.pictures, brightness)), cv::FILLED);
    };
    paint(area(0, 0, 1, 1), 1.75);
    paint(area(0, 0, 1, 0.3), 2.0);  // the lid
    paint(area(0, 0.29, 1, 0.02), 1.2);
    paint(area(0.42, 0, 0.16, 0.55), 2.3);   // tape
    paint(area(0.1, 0.62, 0.25, 0.2), 1.1);  // a label
}

}  // namespace

double mirrorEdge(const CameraModel& camera) {
    return 0.66 * camera.height;
}

ScenePainter::ScenePainter(const World& world, std::size_t view, int margin)
    : world_(world), view_(view), margin_(margin) {
    const CameraModel& camera = world.scenario.camera;
    const cv::Size size(camera.width + 2 * margin, camera.height + 2 * margin);
    room_ = paintRoom(world, view, size);
    fine_ = cv::Mat::zeros(size * kFine, CV_32F);
    fineCovered_ = cv::Mat::zeros(size * kFine, CV_32F);
    body_.create(size, CV_32F);
    covered_.create(size, CV_32F);
}

void ScenePainter::paintBody(const Isometry3d& T_v_r) {
    const auto fineBox = [&] { return cv::Rect(box_.tl() * kFine, box_.size() * kFine); };
    fine_(fineBox()).setTo(0);
    fineCovered_(fineBox()).setTo(0);
    cv::Rect drawn;
    for (const PolygonGroup& group : bodyPolygons(world_, T_v_r))
        drawn |= drawGroup(group, world_, margin_, fine_, fineCovered_);
    const cv::Rect all({0, 0}, body_.size());
    // Wide enough that averages at the edge are of nothing, and where a mirror shows it, all.
    constexpr int kMore = 16;
    box_ = cv::Rect(cv::Point(drawn.x / kFine - kMore, drawn.y / kFine - kMore),
                    cv::Point(drawn.br().x / kFine + kMore, drawn.br().y / kFine + kMore)) &
           all;
    if (world_.scenario.disturbances.reflection > 0)
        box_ = all;
    if (box_.empty())
        return;
    cv::Mat body = body_(box_);
    cv::Mat covered = covered_(box_);
    cv::resize(fine_(fineBox()), body, box_.size(), 0, 0, cv::INTER_AREA);
    cv::resize(fineCovered_(fineBox()), covered, box_.size(), 0, 0, cv::INTER_AREA);
}

void ScenePainter::placeRoom(const Isometry3d& T_r_v) {
    if (view_ >= world_.T_r_v.size() || T_r_v.matrix() == world_.T_r_v[view_].matrix()) {
        room_.copyTo(scene_);
        return;
    }
    constexpr double kDistance = 3;  // m
    const CameraModel& camera = world_.scenario.camera;
    const Isometry3d T_h_v = world_.T_r_v[view_].inverse() * T_r_v;
    const Vector3d turn = so3Log(T_h_v.linear());
    const Vector2d middle(camera.cx + margin_, camera.cy + margin_);
    const Vector2d shift(camera.fx * (turn.y() + T_h_v.translation().x() / kDistance),
                         camera.fy * (-turn.x() + T_h_v.translation().y() / kDistance));
    const Eigen::Matrix2d roll = Eigen::Rotation2Dd(turn.z()).toRotationMatrix();
    const Vector2d offset = middle + shift - roll * middle;
    const cv::Matx23d toRoom(roll(0, 0), roll(0, 1), offset.x(), roll(1, 0), roll(1, 1), offset.y());
    cv::warpAffine(room_, scene_, toRoom, room_.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REFLECT_101);
}

cv::Mat ScenePainter::paint(const Isometry3d& T_r_v) {
    paintBody(T_r_v.inverse());
    placeRoom(T_r_v);
    if (world_.scenario.disturbances.reflection > 0)
        paintMirror(world_, margin_, body_, covered_, scene_);
    if (!box_.empty()) {
        // body + scene (1 - covered)
        cv::Mat scene = scene_(box_);
        cv::Mat covered = covered_(box_);
        cv::subtract(1, covered, covered);  // what roomShare() tells
        cv::multiply(scene, covered, scene);
        cv::add(scene, body_(box_), scene);
    }
    paintOccluder(world_, T_r_v, view_, margin_, scene_);
    cv::Mat blurred;
    cv::GaussianBlur(scene_, blurred, cv::Size(0, 0), world_.scenario.pictures.blur_px);
    cv::max(blurred, 3.0, blurred);
    return blurred;
}

cv::Mat ScenePainter::roomShare() const {
    cv::Mat share(covered_.size(), CV_32F, cv::Scalar(1));
    if (!box_.empty())
        covered_(box_).copyTo(share(box_));
    return share;
}

cv::Mat turnScene(const cv::Mat& scene, const CameraModel& camera, const Matrix3d& R_v_b) {
    const int margin = (scene.cols - camera.width) / 2;
    cv::Mat map(camera.height, camera.width, CV_32FC2);
    for (int y = 0; y < map.rows; ++y) {
        for (int x = 0; x < map.cols; ++x) {
            const Vector3d ray = R_v_b * camera.unproject(Vector2d(x, y)).homogeneous();
            const Vector2d pixel = camera.project(ray).value_or(Vector2d(x, y));
            map.at<cv::Vec2f>(y, x) = {static_cast<float>(pixel.x() + margin), static_cast<float>(pixel.y() + margin)};
        }
    }
    cv::Mat turned;
    cv::remap(scene, turned, map, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    return turned;
}

Person paintPerson(const CameraModel& camera, const RenderOptions& options) {
    // Drawn for a picture of 720 lines and scaled: 0.6 m broad shoulders at some 3 m.
    constexpr int kWidth = 280;
    constexpr int kHeight = 720;
    cv::Mat brightness(kHeight, kWidth, CV_32F, cv::Scalar(1.5));
    cv::Mat cover = cv::Mat::zeros(kHeight, kWidth, CV_32F);
    const auto blob = [&](cv::Point middle, cv::Size radii, double turn, double level) {
        cv::ellipse(brightness, middle, radii, turn, 0, 360, cv::Scalar(level), cv::FILLED);
        cv::ellipse(cover, middle, radii, turn, 0, 360, cv::Scalar(1), cv::FILLED);
    };
    const auto shape = [&](const std::vector<cv::Point>& corners, double level) {
        cv::fillConvexPoly(brightness, corners, cv::Scalar(level));
        cv::fillConvexPoly(cover, corners, cv::Scalar(1));
    };
    shape({{84, 500}, {140, 500}, {140, 720}, {88, 720}}, 0.55);  // legs
    shape({{140, 500}, {198, 500}, {192, 720}, {140, 720}}, 0.45);
    blob({140, 272}, {82, 54}, 0, 1.5);  // shoulders and jacket
    shape({{62, 270}, {218, 270}, {206, 400}, {210, 530}, {72, 530}, {76, 400}}, 1.5);
    blob({68, 390}, {20, 138}, 5, 1.25);  // arms and hands
    blob({212, 390}, {20, 138}, -8, 1.7);
    blob({58, 535}, {15, 22}, 0, 1.9);
    blob({230, 535}, {15, 22}, 0, 1.9);
    shape({{122, 180}, {160, 180}, {166, 240}, {116, 240}}, 1.7);  // neck, hair, face
    blob({139, 128}, {46, 58}, 0, 0.35);
    blob({145, 150}, {37, 46}, 0, 2.1);
    blob({130, 146}, {6, 3}, 0, 0.9);
    blob({161, 146}, {6, 3}, 0, 0.9);
    blob({146, 178}, {11, 3}, 0, 1.5);
    cv::line(brightness, {141, 245}, {141, 530}, cv::Scalar(1.05), 3);  // the zip
    Random random(1, "person");
    brightness = brightness + 0.10 * clouds(brightness.size(), cv::Size(8, 20), random);
    for (int x = 0; x < kWidth; ++x)
        brightness.col(x) *= 1.25 - 0.5 * x / kWidth;  // lit from the left

    Person person;
    const double scale = camera.height / static_cast<double>(kHeight);
    const cv::Size size(static_cast<int>(std::lround(kWidth * scale)), camera.height);
    cv::resize(brightness, person.level, size, 0, 0, cv::INTER_LINEAR);
    cv::resize(cover, person.cover, size, 0, 0, cv::INTER_LINEAR);
    // He walks while the picture is exposed, nearer than the camera is focused.
    const int smear = std::max(1, static_cast<int>(12 * scale));
    for (cv::Mat* layer : {&person.level, &person.cover}) {
        cv::blur(*layer, *layer, cv::Size(smear, 1));
        cv::GaussianBlur(*layer, *layer, cv::Size(0, 0), 2.0 * scale);
    }
    person.level *= options.background;
    return person;
}

}  // namespace skincal
