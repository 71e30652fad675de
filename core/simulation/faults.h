#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

struct World;

/// A gravity pose during which the body shook. Module u reads R_r_u^T (g + acceleration_r) + acceleration_u[u].
struct ShakenPose {
    std::size_t pose = 0;                        ///< position in World::gravity_r
    Vector3d acceleration_r = Vector3d::Zero();  ///< common to all modules, body frame, m/s^2
    std::vector<Vector3d> acceleration_u;        ///< per module, its own part, module frame, m/s^2
};

/// A link between neighbours of which one end's port is reported wrongly.
struct MisportedLink {
    std::size_t link = 0;    ///< position in Skin::links
    std::size_t module = 0;  ///< position in Skin::modules: the end whose port is wrong
    int truePort = 0;
};

/// A view whose camera was knocked half-way: the later half of Skin::modules was seen from the second pose.
struct BumpedView {
    std::size_t view = 0;                             ///< position in World::T_r_v, which holds the pose before
    Isometry3d T_r_v_after = Isometry3d::Identity();  ///< pose after
};

/// Who is to blame for what in a simulated world; for scoring only, never read by a calibration. Numbers are positions
/// in World's and Skin's lists, in increasing order.
struct WorldFaults {
    std::vector<std::size_t> movedModules;
    std::vector<std::size_t> movedPatches;
    std::vector<Isometry3d> T_r_u_before;  ///< per module, while gravity was read; empty where nothing moved
    std::vector<ShakenPose> shakenPoses;
    std::vector<MisportedLink> misportedLinks;
    std::vector<BumpedView> bumpedViews;
    std::vector<std::size_t> wrongTemplates;  ///< modules; World::trueType says what they are
};

/// Lets go wrong in a finished world what Scenario::faults asks for. Culprits come from a random stream of their own:
/// nothing else of the world changes. A module is touched by one fault at most, both modules of a misported link and
/// all modules of a moved patch counted in; modules under a card are spared, as no scan can tell on them. A bumped
/// view sees at least four modules before the knock and four after it.
/// Throws std::logic_error where a size is negative or not a number, where there are fewer patches (the first never
/// moves), modules, poses, links with a free port or views to choose from than faults asked for, where a wrong template
/// is asked for and the scenario has no other with the ports that are in use, and for bumped views of scans with
/// pictures (see DisturbanceOptions::bump_px).
void addFaults(World& world);

/// Pose of a module in the body while gravity was read.
[[nodiscard]] const Isometry3d& poseAtGravity(const World& world, std::size_t module);

}  // namespace skincal
