#pragma once

#include <opencv2/core/mat.hpp>

#include "core/simulation/world.h"

namespace skincal {

/// Paints what a camera sees with all LEDs off, in grey levels (CV_32F), the lens' blur included: a room out of focus,
/// tubes, boards in their elastomer, cards, the mirror and the occluder where the scenario has them. The picture
/// depends on world, view, margin and pose alone, not on what was painted before: the room and the canvas are kept to
/// save time (some 60 MB at 1280x720). The world must outlive it.
class ScenePainter {
  public:
    /// @param view    number of the view: decides by chance how the room is furnished and what an occluder hides
    /// @param margin  pixels more than the picture on each side, for a camera that is knocked afterwards
    ScenePainter(const World& world, std::size_t view, int margin);

    /// The room is painted for the view's own pose; for others it is shifted and rolled as what is three metres away,
    /// and mirrored where it ends. Of a view that the world has not it stays as it is.
    [[nodiscard]] cv::Mat paint(const Isometry3d& T_r_v);

    /// Of what was painted last: share of each pixel through which the room shows (CV_32F), as large as that.
    [[nodiscard]] cv::Mat roomShare() const;

  private:
    void paintBody(const Isometry3d& T_v_r);
    void placeRoom(const Isometry3d& T_r_v);

    const World& world_;
    std::size_t view_;
    int margin_;
    cv::Mat room_;
    cv::Rect box_;         ///< part of the picture outside which there is none of the body
    cv::Mat fine_;         ///< the body, finer than the picture
    cv::Mat fineCovered_;  ///< 1 where there is any of it
    cv::Mat body_;         ///< the same by the picture's pixels; both hold within box_ alone
    cv::Mat covered_;
    cv::Mat scene_;
};

/// A picture of the scene as it is when the camera has turned about its own centre: what showed at pixel p of the one
/// shows at p' of the other, exact at every depth.
///   p = project(R_v_b * unproject(p'))
/// @param scene  from ScenePainter, with enough margin.
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
