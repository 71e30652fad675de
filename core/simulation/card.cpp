#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/simulation/world.h"

namespace skincal {
namespace {

/// How far inside the card's edges a point of its plane lies; negative outside.
double insideBy(const Card& card, const Vector2d& p) {
    return std::min(0.5 * card.width - std::abs(p.x()), 0.5 * card.height - std::abs(p.y()));
}

}  // namespace

void layCard(World& world, std::size_t count) {
    constexpr double kReach = 0.1;       // m: what is farther from the middle is never under the card
    constexpr double kClearance = 1e-3;  // m over the highest corner under it
    // The patch's modules by their LED, in the frame of its middle one.
    const Isometry3d T_u0_r = world.T_r_u.front().inverse();
    std::vector<std::pair<std::size_t, Vector3d>> leds;
    double highest = 0;
    for (std::size_t u = 0; u < world.T_r_u.size() && world.patchOf[u] == world.patchOf.front(); ++u) {
        const Isometry3d T = T_u0_r * world.T_r_u[u];
        const Vector3d led = T * world.trueTemplate(u).led;
        if (led.norm() > kReach)
            continue;
        leds.emplace_back(u, led);
        if (led.norm() > 0.5 * kReach)
            continue;
        for (const Vector2d& corner : world.trueTemplate(u).outline)
            highest = std::max(highest, (T * Vector3d(corner.x(), corner.y(), 0)).z());
    }
    Card card;
    double best = 0;
    for (int turn = 0; turn < 180; turn += 5) {
        const Matrix3d R = Eigen::AngleAxisd(turn * kDegree, Vector3d::UnitZ()).toRotationMatrix();
        for (int x = -20; x <= 20; x += 2) {
            for (int y = -20; y <= 20; y += 2) {
                const Isometry3d T_u0_k = makeIsometry(R, {1e-3 * x, 1e-3 * y, highest + kClearance});
                double margin = kReach;
                std::vector<std::size_t> covered;
                for (const auto& [u, led] : leds) {
                    const double inside = insideBy(card, (T_u0_k.inverse() * led).head<2>());
                    margin = std::min(margin, std::abs(inside));
                    if (inside > 0)
                        covered.push_back(u);
                }
                if (covered.size() != count || margin <= best)
                    continue;
                best = margin;
                card.T_r_k = world.T_r_u.front() * T_u0_k;
                world.covered = covered;
            }
        }
    }
    if (best <= 0)
        throw std::logic_error("layCard: no place of the card covers that many LEDs");
    world.cards.push_back(card);
}

}  // namespace skincal
