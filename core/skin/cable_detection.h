#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/se3.h"
#include "core/skin/skin_graph.h"

namespace skincal {

/// Why a link was judged as it was.
enum class LinkReason {
    Neighbours,     ///< nothing speaks against it
    OperatorsWord,  ///< decided in the recording
    SelfLink,
    ComputerPort,   ///< the port is wired to the computer
    Contradictory,  ///< another link claims the same port, and this one is not the one that fits
    Bend,           ///< the two boards are folded more than neighbours can be
    Twist,          ///< turned in the plane of the skin more than neighbours can be
    Separation,     ///< the LEDs are far apart in the pictures
};

struct LinkVerdict {
    LinkKind kind = LinkKind::Adjacent;
    LinkReason reason = LinkReason::Neighbours;
    std::string explanation;      ///< in plain English, with the number that decided
    std::optional<double> bend;   ///< rad, see bendAndTwist
    std::optional<double> twist;  ///< rad
};

/// What was measured about the links of a graph, entry by entry; nothing where it could not be.
struct CableEvidence {
    std::vector<std::optional<Matrix3d>> R_a_b;     ///< relative rotation from gravity
    std::vector<std::optional<double>> separation;  ///< distance in the pictures, times that of neighbours
};

struct CableOptions {
    /// On a radius of 40 mm, the paper's tightest, its cells bend by 40 degrees to their neighbours; on 21 mm by 75.
    double maxBend = 75 * kDegree;
    /// The mould holds the ports face to face. An uncalibrated accelerometer adds some 4 degrees, 25 is far beyond.
    double maxTwist = 25 * kDegree;
    /// Seen 60 degrees aside, a row of neighbours along the axis of the tilt is twice as long as one across it.
    double maxSeparation = 2.2;

    [[nodiscard]] bool validate() const;
};

/// R_a_b of two neighbours that lie flat: port a and port b face each other, both boards in one plane.
///   R_a_b = Rz(azimuth(p_a) + pi - azimuth(p_b))
[[nodiscard]] Matrix3d flatNeighbourRotation(const Vector3d& port_a, const Vector3d& port_b);

struct BendAndTwist {
    double bend = 0;   ///< angle between the two normals, [0, pi]
    double twist = 0;  ///< turn about the normal that is left when the bend is taken out, [0, pi]; 0 at bend pi
};
/// How R_a_b differs from the flat arrangement (swing-twist decomposition of R_a_b * flat^T about z).
[[nodiscard]] BendAndTwist bendAndTwist(const Matrix3d& R_a_b, const Matrix3d& flat);

/// Tells neighbours from cables by all the ways of METHOD.md: the operator's word, which beats everything but sense (no
/// module is its own neighbour); links to the computer; relative rotations beyond the physical limit; distance in the
/// pictures. Where several links claim one port, the one that the operator called a neighbour is taken, else the only
/// one whose rotation was measured and fits, else none.
/// @return one verdict per link of the graph, in its order; the same whichever end of a link is called a.
/// Throws std::logic_error where the evidence does not fit the graph or the options are out of range.
[[nodiscard]] std::vector<LinkVerdict> detectCables(const Skin& skin, const SkinGraph& graph,
                                                    const CableEvidence& evidence, const CableOptions& options = {});

}  // namespace skincal
