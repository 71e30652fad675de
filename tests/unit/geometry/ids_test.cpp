#include "core/geometry/ids.h"

#include <gtest/gtest.h>

#include <type_traits>
#include <unordered_set>

#include "core/geometry/run_context.h"

namespace skincal {
namespace {

static_assert(!std::is_convertible_v<ModuleId, PatchId> && !std::is_constructible_v<ModuleId, PatchId>);
static_assert(!std::is_convertible_v<std::uint32_t, ModuleId> && !std::is_convertible_v<ModuleId, std::uint32_t>);

TEST(Ids, OrderLikeTheirNumbers) {
    EXPECT_LT(ModuleId(3), ModuleId(17));
    EXPECT_GT(ModuleId(4294967295U), ModuleId(17));
    EXPECT_EQ(ModuleId(17), ModuleId(17));
    EXPECT_NE(ModuleId(17), ModuleId(18));
    EXPECT_EQ(ModuleId().value, 0U);
}

TEST(Ids, ServeAsKeys) {
    const std::unordered_set<ModuleId> ids{ModuleId(1), ModuleId(2), ModuleId(1)};
    EXPECT_EQ(ids.size(), 2U);
    EXPECT_TRUE(ids.count(ModuleId(2)) == 1 && ids.count(ModuleId(3)) == 0);
}

TEST(RunContext, RunsToTheEndByDefault) {
    const RunContext context;
    EXPECT_FALSE(context.isCancelled());
    EXPECT_NO_THROW(context.report(Sentence::saying("anything"), 0.5));
}

}  // namespace
}  // namespace skincal
