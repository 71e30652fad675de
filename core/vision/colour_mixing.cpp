#include "core/vision/colour_mixing.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <set>

#include "core/vision/frame_pixels.h"
#include "core/vision/paper_frames.h"

namespace skincal {
namespace {

constexpr int kClipped = FramePixels::kTop;

struct Primary {
    FramePair pictures;
    std::set<ModuleId> modules;
};

bool isAllIn(const std::vector<LitModule>& lit, const std::array<int, 3>& colour) {
    return std::all_of(lit.begin(), lit.end(), [&](const LitModule& one) { return colourOf(one) == colour; });
}

/// The picture in which most modules shine in one colour.
std::optional<Primary> primaryIn(std::span<const FrameInfo> frames, const std::array<int, 3>& colour) {
    const auto backgrounds = nearestBackgrounds(frames);
    std::optional<Primary> best;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const auto& lit = frames[k].lit;
        if (!backgrounds[k] || lit.empty() || !isAllIn(lit, colour) || (best && lit.size() <= best->modules.size()))
            continue;
        best = Primary{{k, *backgrounds[k]}, {}};
        for (const LitModule& one : lit)
            best->modules.insert(one.module);
    }
    return best;
}

/// Light of the three pictures summed over the pixels in which all of them have some, a column per colour; zero where
/// those are too few.
Eigen::Matrix3d lightOf(const std::array<cv::Mat, 3>& bright, const std::array<cv::Mat, 3>& dark) {
    constexpr int kLeast = 15;   // grey levels, above noise and its neighbours' halos
    constexpr int kFewest = 30;  // pixels
    int pixels = 0;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int y = 0; y < bright[0].rows; ++y) {
        for (int x = 0; x < bright[0].cols; ++x) {
            Eigen::Matrix3d here;
            bool counts = true;
            for (int colour = 0; colour < 3 && counts; ++colour) {
                const auto& on = bright.at(static_cast<std::size_t>(colour)).at<cv::Vec3b>(y, x);
                const auto& off = dark.at(static_cast<std::size_t>(colour)).at<cv::Vec3b>(y, x);
                for (int channel = 0; channel < 3; ++channel) {
                    counts = counts && on[channel] < kClipped;
                    here(channel, colour) = on[channel] - off[channel];
                }
                counts = counts && here.col(colour).maxCoeff() >= kLeast;
            }
            if (counts) {
                sum += here;
                ++pixels;
            }
        }
    }
    return pixels >= kFewest ? sum : Eigen::Matrix3d::Zero();
}

/// Scaled so that no light becomes clipped that was not; nothing where colours can't be told apart.
std::optional<Eigen::Matrix3d> mixingOf(const Eigen::Matrix3d& light) {
    if (light.diagonal().minCoeff() <= 0)
        return std::nullopt;
    Eigen::Matrix3d M = light / std::cbrt(light.diagonal().prod());
    constexpr double kWorst = 8;  // by which noise would grow
    const Eigen::FullPivLU<Eigen::Matrix3d> factor(M);
    if (!factor.isInvertible() || factor.inverse().rowwise().norm().maxCoeff() > kWorst)
        return std::nullopt;
    const double brightest = factor.inverse().cwiseMax(0).rowwise().sum().maxCoeff();
    constexpr double kRoom = (kClipped - ColourMixing::kGround) / kClipped;
    M *= std::max(1.0, brightest / kRoom);
    return M;
}

}  // namespace

tl::expected<std::optional<ColourMixing>, std::string> ColourMixing::measured(std::span<const FrameInfo> frames,
                                                                              const FrameLoader& load) {
    // Colours are given as RGB, pictures are BGR.
    static constexpr std::array<std::array<int, 3>, 3> kColours{{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}};
    std::array<cv::Mat, 3> bright;
    std::array<cv::Mat, 3> dark;
    std::set<ModuleId> modules;
    for (std::size_t i = 0; i < kColours.size(); ++i) {
        const auto primary = primaryIn(frames, kColours.at(i));
        if (!primary || (i > 0 && primary->modules != modules))
            return std::nullopt;
        modules = primary->modules;
        for (auto [to, from] : {std::pair(&bright.at(i), primary->pictures.foreground),
                                std::pair(&dark.at(i), primary->pictures.background)}) {
            auto picture = load(from);
            if (!picture)
                return tl::unexpected(std::move(picture.error()));
            // What else is wrong with it whoever decodes it says.
            if (picture->type() != CV_8UC3 || (!bright[0].empty() && picture->size() != bright[0].size()))
                return std::nullopt;
            *to = *std::move(picture);
        }
    }
    const auto M = mixingOf(lightOf(bright, dark));
    return M ? std::optional(ColourMixing(*M, dark[0])) : std::nullopt;
}

cv::Mat ColourMixing::unmixed(const cv::Mat& picture) const {
    if (picture.type() != CV_8UC3 || picture.size() != dark_.size())
        return picture;
    const Eigen::Matrix3d inverse = M_.inverse();
    const cv::Matx34f transform(static_cast<float>(inverse(0, 0)), static_cast<float>(inverse(0, 1)),
                                static_cast<float>(inverse(0, 2)), kGround, static_cast<float>(inverse(1, 0)),
                                static_cast<float>(inverse(1, 1)), static_cast<float>(inverse(1, 2)), kGround,
                                static_cast<float>(inverse(2, 0)), static_cast<float>(inverse(2, 1)),
                                static_cast<float>(inverse(2, 2)), kGround);
    cv::Mat light;
    cv::subtract(picture, dark_, light, cv::noArray(), CV_32F);
    cv::transform(light, light, transform);
    cv::Mat pure;
    light.convertTo(pure, CV_8U);
    return cv::max(pure, picture >= kClipped);
}

}  // namespace skincal
