#pragma once

#include <optional>
#include <vector>

#include "core/geometry/se3.h"
#include "core/geometry/sentence.h"
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
    Movement,       ///< the two boards turned against each other between the poses: a joint is between them
    Separation,     ///< the LEDs are far apart in the pictures
    Gap,            ///< the two ports are far apart in a solution that took them for one point
    Refuted,        ///< everything else that was measured contradicts it
};

struct LinkVerdict {
    LinkKind kind = LinkKind::Adjacent;
    LinkReason reason = LinkReason::Neighbours;
    Sentence explanation;         ///< with the number that decided
    std::optional<double> bend;   ///< rad, see bendAndTwist
    std::optional<double> twist;  ///< rad
};

/// What was measured about the links of a graph, entry by entry; nothing where it could not be.
struct CableEvidence {
    CableEvidence() = default;
    /// Nothing measured about any of so many links.
    explicit CableEvidence(std::size_t links)
        : R_a_b(links), rotationResidual(links), separation(links), gap(links), refuted(links) {}

    std::vector<std::optional<Matrix3d>> R_a_b;  ///< relative rotation from gravity
    /// How much the readings of the two ends differ all the same, rms over the poses, m/s^2.
    std::vector<std::optional<double>> rotationResidual;
    std::vector<std::optional<double>> separation;  ///< distance in the pictures, times that of neighbours
    std::vector<std::optional<double>> gap;         ///< between the two ports in an earlier solution, m
    std::vector<Sentence> refuted;                  ///< how a solution without it contradicts it; empty where none does
};

struct CableOptions {
    /// On a radius of 40 mm, the paper's tightest, its cells bend by 40 degrees to their neighbours; on 21 mm by 75.
    double maxBend = 75 * kDegree;
    /// The mould holds the ports face to face. An uncalibrated accelerometer adds some 4 degrees, 25 is far beyond.
    double maxTwist = 25 * kDegree;
    /// m/s^2. Two uncalibrated accelerometers may differ by 2; a joint that turns by 45 degrees between poses by 5.
    double maxRotationResidual = 3.5;
    /// Seen 60 degrees aside, a row of neighbours along the axis of the tilt is twice as long as one across it.
    double maxSeparation = 2.2;
    /// m. Play is a fraction of a millimetre; more than this between two ports is no gap in an elastomer mould.
    double maxGap = 5e-3;

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

/// Tells neighbours from cables by all the ways that the paper names and some more: the operator's word, which beats
/// everything but sense (no module is its own neighbour); links to the computer; relative rotations beyond the physical
/// limit; distance in the pictures. Where several links claim one port, the one that the operator called a neighbour is
/// taken, else the only one whose rotation was measured and fits, else none.
/// @return one verdict per link of the graph, in its order; the same whichever end of a link is called a.
/// Throws std::logic_error where the evidence does not fit the graph or the options are out of range.
[[nodiscard]] std::vector<LinkVerdict> detectCables(const Skin& skin, const SkinGraph& graph,
                                                    const CableEvidence& evidence, const CableOptions& options = {});

}  // namespace skincal
