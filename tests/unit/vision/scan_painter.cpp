#include "tests/unit/vision/scan_painter.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>

#include <set>

namespace skincal::testing {

void addSpot(cv::Mat& light, const Vector2d& at, double peak, double width_px) {
    const int reach = static_cast<int>(std::ceil(4.5 * width_px));
    const int cx = static_cast<int>(std::lround(at.x()));
    const int cy = static_cast<int>(std::lround(at.y()));
    for (int y = std::max(0, cy - reach); y <= std::min(light.rows - 1, cy + reach); ++y) {
        for (int x = std::max(0, cx - reach); x <= std::min(light.cols - 1, cx + reach); ++x) {
            const double r2 = (Vector2d(x, y) - at).squaredNorm() / (2 * width_px * width_px);
            light.at<float>(y, x) += static_cast<float>(peak * std::exp(-r2));
        }
    }
}

cv::Mat ScanPainter::paint(std::size_t k) const {
    Random random(seed * 1'000'003 + k, "camera noise");
    std::vector<cv::Mat> planes;
    for (std::size_t channel = 0; channel < (colour ? 3U : 1U); ++channel) {
        cv::Mat light(size, CV_32F);
        for (int y = 0; y < size.height; ++y) {
            for (int x = 0; x < size.width; ++x)
                light.at<float>(y, x) = static_cast<float>(50 + 0.1 * x + 15 * std::sin(0.11 * x) * std::cos(0.07 * y));
        }
        for (const LitModule& lit : frames[k].lit) {
            double share = 1;
            if (lit.colour) {
                const auto& [red, green, blue] = *lit.colour;
                share = mixing.row(static_cast<Eigen::Index>(channel)).dot(Vector3d(blue, green, red));
            }
            for (const auto* group : {&leds, &mirrored}) {
                for (const PaintedLed& led : *group) {
                    if (led.module != lit.module || !(led.peak * share > 0))
                        continue;
                    addSpot(light, led.pixel, led.peak * share, width_px);
                    addSpot(light, led.pixel, led.peak * share * halo, 2.5 * width_px);
                }
            }
        }
        if (disturb)
            disturb(light, k);
        cv::Mat plane(size, CV_8U);
        for (int y = 0; y < size.height; ++y) {
            for (int x = 0; x < size.width; ++x) {
                const auto clean = static_cast<double>(light.at<float>(y, x));
                const double sigma = std::sqrt(readNoise * readNoise + shotGain * std::max(0.0, clean));
                plane.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(clean + sigma * random.normal());
            }
        }
        planes.push_back(plane);
    }
    cv::Mat picture;
    cv::merge(planes, picture);
    return picture;
}

FrameLoader ScanPainter::loader() const {
    return [this](std::size_t k) -> tl::expected<cv::Mat, std::string> { return paint(k); };
}

std::vector<ModuleId> ScanPainter::modules() const {
    std::vector<ModuleId> ids;
    for (const PaintedLed& led : leds)
        ids.push_back(led.module);
    return ids;
}

std::vector<PaintedLed> scatterLeds(Random& random, std::size_t count, cv::Size size, double apart, double margin) {
    std::vector<PaintedLed> leds;
    while (leds.size() < count) {
        const Vector2d at(random.uniform(margin, size.width - 1 - margin),
                          random.uniform(margin, size.height - 1 - margin));
        const bool free = std::all_of(leds.begin(), leds.end(),
                                      [&](const PaintedLed& led) { return (led.pixel - at).norm() >= apart; });
        if (free)
            leds.push_back({ModuleId(static_cast<std::uint32_t>(100 + 7 * leds.size())), at, random.uniform(60, 170)});
    }
    return leds;
}

std::vector<FrameInfo> oneAtATime(const std::vector<PaintedLed>& leds, int repeats) {
    std::vector<FrameInfo> frames{{"background.png", {}}};
    for (const PaintedLed& led : leds) {
        for (int repeat = 0; repeat < repeats; ++repeat) {
            frames.push_back({fmt::format("led{}.png", led.module.value), {{led.module}}});
            frames.push_back({"background.png", {}});
        }
    }
    return frames;
}

std::vector<FrameInfo> coded(const std::vector<PaintedLed>& leds, Random& random) {
    std::size_t bits = 2;
    while ((std::size_t{1} << bits) < 4 * leds.size())
        ++bits;
    std::set<std::size_t> taken;
    std::vector<std::size_t> words;
    while (words.size() < leds.size()) {
        const std::size_t word = random.index(std::size_t{1} << bits);
        if (taken.insert(word).second)
            words.push_back(word);
    }
    std::vector<FrameInfo> frames{{"dark.png", {}}, {"all.png", {}}};
    for (const PaintedLed& led : leds)
        frames[1].lit.push_back({led.module});
    for (std::size_t bit = 0; bit < bits; ++bit) {
        for (const std::size_t wanted : {std::size_t{1}, std::size_t{0}}) {
            FrameInfo frame{fmt::format("bit{}-{}.png", bit, wanted), {}};
            for (std::size_t u = 0; u < leds.size(); ++u) {
                if (((words[u] >> bit) & 1U) == wanted)
                    frame.lit.push_back({leds[u].module});
            }
            frames.push_back(frame);
        }
    }
    return frames;
}

}  // namespace skincal::testing
