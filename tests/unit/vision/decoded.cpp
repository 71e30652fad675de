#include "tests/unit/vision/decoded.h"

#include <gtest/gtest.h>

#include <unordered_map>

namespace skincal::testing {

ViewDetections decode(const ScanPainter& scan, const DecoderOptions& options) {
    const auto view = decodeView("view", scan.modules(), scan.frames, scan.loader(), options);
    EXPECT_TRUE(view.has_value()) << (view ? "" : view.error().message.english());
    return view ? *view : ViewDetections{};
}

const Undetected* missing(const ViewDetections& view, ModuleId module) {
    for (const Undetected& u : view.undetected) {
        if (u.module == module)
            return &u;
    }
    return nullptr;
}

std::size_t expectNoneWrong(const ScanPainter& scan, const ViewDetections& view, double tolerance_px) {
    EXPECT_EQ(view.found.size() + view.undetected.size(), scan.leds.size());
    std::unordered_map<ModuleId, PaintedLed> truth;
    for (const PaintedLed& led : scan.leds)
        truth.emplace(led.module, led);
    for (const LedDetection& found : view.found) {
        const PaintedLed& led = truth.at(found.module);
        EXPECT_GT(led.peak, 0) << "a covered module was found: " << found.module.value;
        EXPECT_LT((found.pixel - led.pixel).norm(), tolerance_px) << "module " << found.module.value;
        EXPECT_GT(found.sigma_px, 0);
    }
    for (const Undetected& u : view.undetected) {
        EXPECT_FALSE(u.reason.empty());
        EXPECT_NE(u.verdict, DetectionVerdict::Found);
    }
    return view.found.size();
}

}  // namespace skincal::testing
