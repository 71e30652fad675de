#include "core/estimation/gravity_alignment.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/estimation/edge_rotation.h"

namespace skincal {
namespace {

using Directions = std::vector<std::optional<Vector3d>>;

struct Agreement {
    GravityFrame frame;
    std::size_t count = 0;
};

Agreement agreementWith(const Directions& reference, const std::vector<Directions>& up_o, double limit) {
    Agreement agreement;
    agreement.frame.R_g_o.resize(up_o.size());
    double squares = 0;
    for (std::size_t k = 0; k < up_o.size(); ++k) {
        std::vector<Vector3d> g;
        std::vector<Vector3d> o;
        for (std::size_t p = 0; p < up_o[k].size(); ++p) {
            if (up_o[k][p] && reference[p]) {
                g.push_back(*reference[p]);
                o.push_back(*up_o[k][p]);
            }
        }
        const auto rotation = estimateRelativeRotation(g, o);
        // Unit vectors: the residual is an angle.
        if (!rotation || rotation->residual_rms > limit)
            continue;
        agreement.frame.R_g_o[k] = rotation->R_c_n;
        squares += rotation->residual_rms * rotation->residual_rms;
        ++agreement.count;
    }
    if (agreement.count > 0)
        agreement.frame.disagreement_rad = std::sqrt(squares / static_cast<double>(agreement.count));
    return agreement;
}

}  // namespace

GravityFrame alignPatchesByGravity(const std::vector<Directions>& up_o, const GravityAlignmentOptions& options) {
    if (!options.validate())
        throw std::logic_error("GravityAlignmentOptions out of range");
    // Patches that know the most poses make the best references.
    std::vector<std::size_t> order(up_o.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto known = [&](std::size_t k) {
        return std::count_if(up_o[k].begin(), up_o[k].end(), [](const auto& up) { return up.has_value(); });
    };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return known(a) > known(b); });

    Agreement best;
    best.frame.R_g_o.resize(up_o.size());
    for (std::size_t i = 0; i < std::min(order.size(), options.maxReferences); ++i) {
        Agreement agreement = agreementWith(up_o[order[i]], up_o, options.maxDisagreement_rad);
        if (agreement.count > best.count)
            best = std::move(agreement);
        if (2 * best.count > up_o.size())
            break;  // no other set can be larger
    }
    return best.frame;
}

}  // namespace skincal
