#include "core/vision/clipped_planes.h"

#include "core/geometry/statistics.h"

namespace skincal {

std::vector<std::uint8_t> blackPlanes(const Eigen::Ref<const Eigen::VectorXf>& around) {
    constexpr float kBlack = 1;
    constexpr double kLit = 8;
    std::vector<std::uint8_t> black(static_cast<std::size_t>(around.size()), 0);
    if (around.size() == 0 || around.minCoeff() >= kBlack ||
        median({around.data(), around.data() + around.size()}) < kLit)
        return black;
    for (std::size_t k = 0; k < black.size(); ++k)
        black[k] = around[static_cast<Eigen::Index>(k)] < kBlack ? 1 : 0;
    return black;
}

std::vector<std::uint8_t> atLeastPlanes(const Eigen::Ref<const Eigen::Array<std::uint8_t, Eigen::Dynamic, 1>>& isFull,
                                        const Eigen::Ref<const Eigen::VectorXf>& around) {
    constexpr double kAlways = 0.9;
    std::vector<std::uint8_t> atLeast = blackPlanes(around);
    const double share = isFull.size() > 0 ? isFull.cast<double>().mean() : 0.0;
    if (share > kAlways)
        return atLeast;
    for (std::size_t k = 0; k < atLeast.size(); ++k) {
        if (isFull[static_cast<Eigen::Index>(k)] != 0)
            atLeast[k] = 1;
    }
    return atLeast;
}

}  // namespace skincal
