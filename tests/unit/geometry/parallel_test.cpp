#include "core/geometry/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace skincal {
namespace {

TEST(ForEachInParallel, EveryTurnIsTakenOnce) {
    for (const std::size_t count : {0, 1, 7, 64, 1000}) {
        for (const std::size_t chunk : {1, 3, 64, 5000}) {
            std::vector<int> turns(count, 0);
            forEachInParallel(count, chunk, [&](std::size_t i) { ++turns[i]; });
            EXPECT_EQ(turns, std::vector<int>(count, 1)) << count << " in chunks of " << chunk;
        }
    }
}

TEST(ForEachInParallel, TheCallersThreadAloneIsAskedMeanwhile) {
    const std::thread::id caller = std::this_thread::get_id();
    forEachInParallel(
        100, 2, [](std::size_t) {},
        [&](std::size_t) {
            EXPECT_EQ(std::this_thread::get_id(), caller);
            return true;
        });
}

TEST(ForEachInParallel, TheCallersThreadIsAskedWhileItWaitsForTheOthers) {
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<bool> asked = false;
    std::atomic<int> left = 0;
    forEachInParallel(
        1000, 1,
        [&](std::size_t) {
            // The first turn of each other thread lasts until the caller has nothing left to do.
            if (std::this_thread::get_id() == caller)
                return;
            while (!asked)
                std::this_thread::yield();
            ++left;
        },
        [](std::size_t) { return true; },
        [&] {
            EXPECT_EQ(std::this_thread::get_id(), caller);
            asked = true;
        });
    EXPECT_TRUE(asked || left == 0);
}

TEST(ForEachInParallel, StopsBetweenChunks) {
    constexpr std::size_t kMany = 1'000'000;
    std::atomic<std::size_t> taken = 0;
    std::atomic<bool> asked = false;
    forEachInParallel(
        kMany, 1,
        [&](std::size_t) {
            while (!asked)
                std::this_thread::yield();
            ++taken;
        },
        [&](std::size_t) {
            asked = true;
            return false;
        });
    EXPECT_LT(taken, kMany);
}

TEST(ForEachInParallel, AnExceptionReachesTheCaller) {
    EXPECT_THROW(forEachInParallel(100, 1,
                                   [](std::size_t i) {
                                       if (i == 42)
                                           throw std::runtime_error("turn 42");
                                   }),
                 std::runtime_error);
}

}  // namespace
}  // namespace skincal
