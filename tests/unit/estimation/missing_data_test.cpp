#include "core/estimation/missing_data.h"

#include <gmock/gmock.h>

namespace skincal {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class WhyNotPlacedTest : public testing::Test {
  protected:
    WhyNotPlacedTest() {
        skin_.templates = {paperHexagon()};
        skin_.modules = {{ModuleId(5), 0}, {ModuleId(7), 0}};
        patch_.modules = {0, 1, 2, 3, 4};
    }
    std::string text(const PatchEvidence& evidence, bool anyPlaced = true) const {
        return whyNotPlaced(skin_, patch_, evidence, 4, anyPlaced).english();
    }
    Skin skin_;
    Patch patch_;
};

TEST_F(WhyNotPlacedTest, SaysWhatToDo) {
    EXPECT_EQ(text({}), "patch 0 (origin 5) was seen in no view: add one that shows it beside a placed patch");
    EXPECT_EQ(text({3, 3, {}}),
              "patch 0 (origin 5) showed at most 3 LEDs in a view, 4 are needed: move the camera closer or more in "
              "front of it");
    EXPECT_THAT(text({9, 1, {}}), HasSubstr("showed 9 LEDs in a view, but only 1 of their modules have gravity"));
    EXPECT_THAT(text({1, 0, {}}), HasSubstr("showed 1 LED in a view, but none of their modules have gravity"));
    EXPECT_THAT(text({9, 9, {{ErrorCode::DegeneratePoints, 2}, {ErrorCode::NoConsensus, 1}}}),
                HasSubstr("only LEDs in one line"));
    EXPECT_THAT(text({9, 9, {{ErrorCode::NoConsensus, 3}}}), HasSubstr("nowhere where its shape explains the LEDs"));
    EXPECT_THAT(text({9, 9, {}}, false), HasSubstr("could be in two places in each view"));
    EXPECT_EQ(text({4, 4, {}}), "patch 0 (origin 5) was never seen with a placed patch: add a view that shows both");
}

TEST_F(WhyNotPlacedTest, AsksNoPatchForMoreLedsThanItHas) {
    patch_.modules = {0, 1};
    EXPECT_EQ(text({2, 2, {}}),
              "patch 0 (origin 5) has 2 of the 4 LEDs that a pose takes: show it in two views or more in which other "
              "patches are placed");
}

TEST_F(WhyNotPlacedTest, CountsWhatIsSeenAndWhatIsUsable) {
    SkinLayout layout;
    patch_.modules = {0, 1};
    layout.patches = {patch_};
    layout.patchOf = {0, 0};
    PatchShape shape;
    shape.T_o_u = {Isometry3d::Identity(), std::nullopt};
    const auto evidence = patchEvidence(layout, {shape}, {{0, 0, {}, 0.1}, {1, 0, {}, 0.1}, {1, 1, {}, 0.1}});
    ASSERT_EQ(evidence.size(), 1U);
    EXPECT_EQ(evidence[0].mostDetected, 2U);
    EXPECT_EQ(evidence[0].mostUsable, 1U);
}

TEST(WhyNotHeld, NamesAHandfulOfModules) {
    Skin skin;
    std::vector<std::size_t> all;
    for (std::uint32_t m = 0; m < 11; ++m) {
        skin.modules.push_back({ModuleId(m + 20), 0});
        all.push_back(m);
    }
    EXPECT_EQ(whyNotHeld(skin, {}), "");
    EXPECT_THAT(whyNotHeld(skin, {1}).english(), StartsWith("module 21: no gravity readings tell how it lies"));
    EXPECT_THAT(whyNotHeld(skin, {0, 2}).english(), StartsWith("modules 20 and 22: no gravity readings"));
    EXPECT_THAT(whyNotHeld(skin, all), HasSubstr("27 and 3 more: "));
}

}  // namespace
}  // namespace skincal
