#pragma once

#include <opencv2/core/mat.hpp>

#include "core/simulation/world.h"

namespace skincal {

/// What the camera of a view sees with all LEDs off, in grey levels (CV_32F), the lens' blur included: a room out of
/// focus, tubes, boards in their elastomer, cards, the mirror and the occluder where the scenario has them.
/// @param T_r_v   where the camera stands
/// @param room    from paintRoom
/// @param view    number of the view: decides by chance what an occluder hides
/// @param margin  pixels more than the picture on each side, for a camera that is knocked afterwards
[[nodiscard]] cv::Mat paintScene(const World& world, const Isometry3d& T_r_v, const cv::Mat& room, std::size_t view,
                                 int margin);

/// Wall, shelf with books, a screen and a table, behind what the camera is focused on: grey levels (CV_32F). The number
/// of the view decides by chance how it is furnished, whatever the camera's pose.
[[nodiscard]] cv::Mat paintRoom(const World& world, std::size_t view, int margin);

/// A picture of the scene as it is when the camera has turned about its own centre: what showed at pixel p of the one
/// shows at p' of the other, exact at every depth.
///   p = project(R_v_b * unproject(p'))
/// @param scene  from paintScene, with enough margin.
[[nodiscard]] cv::Mat turnScene(const cv::Mat& scene, const CameraModel& camera, const Matrix3d& R_v_b);

/// Somebody who walks by: what he looks like, and how much of what is behind him he hides, pixel by pixel (0 to 1, with
/// a soft edge: out of focus and in motion). Both CV_32F, as high as the picture.
struct Person {
    cv::Mat level;
    cv::Mat cover;
};
[[nodiscard]] Person paintPerson(const CameraModel& camera, const RenderOptions& options);

/// Height in the picture of the edge of the mirror below the body; what is above is seen again below it.
[[nodiscard]] double mirrorEdge(const CameraModel& camera);

}  // namespace skincal
