// What is kept of a tactile stream, and what is shown of it.

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "core/geometry/random.h"
#include "ui/presenters/tactile_picture.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using Time = TactileHistory::Time;

std::vector<ModuleId> modulesUpTo(unsigned count) {
    std::vector<ModuleId> modules;
    for (unsigned i = 1; i <= count; ++i)
        modules.emplace_back(i);
    return modules;
}

TactileSample sampleAt(Time time, const std::vector<ModuleId>& modules, float force) {
    TactileSample sample;
    sample.time = time;
    for (const ModuleId module : modules) {
        TactileSample::Reading reading;
        reading.module = module;
        reading.proximity = 0.5F;
        reading.force = {force, 0, 0};
        reading.temperature = 25;
        reading.acceleration = {3, 4, 12};
        sample.readings.push_back(reading);
    }
    return sample;
}

TEST(TactileHistory, KeepsNoMoreThanItsFramesNorItsSpan) {
    Random random(1, "history");
    for (int round = 0; round < 20; ++round) {
        const auto modules = modulesUpTo(3);
        const auto frames = static_cast<std::size_t>(1 + 50 * random.uniform());
        TactileHistory history(modules, frames);
        std::deque<Time> kept;
        Time now{1};
        for (int i = 0; i < 200; ++i) {
            now += Time(1 + static_cast<std::int64_t>(random.uniform() * (i % 50 == 49 ? 4e7 : 1e6)));
            history.add(sampleAt(now, modules, static_cast<float>(i % 8)));
            kept.push_back(now);
            while (kept.size() > frames || now - kept.front() > TactileHistory::kSpan)
                kept.pop_front();
            ASSERT_EQ(history.size(), kept.size());
            for (std::size_t k = 0; k < kept.size(); ++k)
                ASSERT_EQ(history.timeOf(k), kept[k]);
            ASSERT_FLOAT_EQ(history.at(history.size() - 1)[2].force(), static_cast<float>(i % 8));
            const Time asked = kept.front() + Time(static_cast<std::int64_t>(random.uniform() * 4e7)) - 1s;
            const std::size_t found = *history.frameAt(asked);
            ASSERT_TRUE(kept[found] <= asked || found == 0);
            ASSERT_TRUE(found + 1 == kept.size() || kept[found + 1] > asked);
        }
    }
}

TEST(TactileHistory, SortsReadingsByModuleWhateverTheirOrder) {
    TactileHistory history(modulesUpTo(4));
    EXPECT_FALSE(history.frameAt(1s).has_value());
    history.add(sampleAt(1s, {ModuleId(3), ModuleId(99), ModuleId(1)}, 2));
    EXPECT_TRUE(history.at(0)[0].isKnown());
    EXPECT_FALSE(history.at(0)[1].isKnown());
    EXPECT_TRUE(history.at(0)[2].isKnown());
    history.add(sampleAt(2s, {ModuleId(2), ModuleId(4), ModuleId(99)}, 2));
    EXPECT_FALSE(history.at(1)[0].isKnown());
    EXPECT_TRUE(history.at(1)[1].isKnown());
    EXPECT_TRUE(history.at(1)[3].isKnown());
    // Its clock was set back.
    history.add(sampleAt(1500ms, modulesUpTo(4), 2));
    EXPECT_EQ(history.size(), 1U);
    EXPECT_FLOAT_EQ(valueOf(history.at(0)[3], Quantity::Acceleration), 13);
    EXPECT_THROW(TactileHistory(modulesUpTo(1), 0), std::logic_error);
}

TEST(TactilePicture, ListsTheStrongestContactsFirst) {
    BodyModel body;
    body.templates = {paperHexagon()};
    for (const ModuleId id : modulesUpTo(20)) {
        BodyModule& module = body.modules.emplace_back();
        module.id = id;
        module.type = "hex";
        if (id.value != 20)
            module.T_body_module = Isometry3d(Eigen::Translation3d(0.03 * id.value, 0, 0));
    }
    TactileHistory history(modulesUpTo(20));
    TactileSample sample = sampleAt(1s, modulesUpTo(20), 0.05F);
    for (const auto& [module, force] : {std::pair{4, 3.0F}, {20, 7.0F}, {9, 1.0F}})
        sample.readings[static_cast<std::size_t>(module - 1)].force = {0, force, 0};
    sample.readings.erase(sample.readings.begin() + 11);
    history.add(sample);
    TactilePicture picture;
    drawPicture(picture, history.at(0), Quantity::Force, body);
    ASSERT_EQ(picture.contacts.size(), 3U);
    EXPECT_EQ(picture.contacts[0].module, ModuleId(20));
    EXPECT_FALSE(picture.contacts[0].position_r.has_value());
    EXPECT_EQ(picture.contacts[1].module, ModuleId(4));
    EXPECT_NEAR((*picture.contacts[1].position_r - Vector3d(0.12 + 0.0045, -0.0075, 0)).norm(), 0, 1e-9);
    EXPECT_EQ(picture.contacts[2].module, ModuleId(9));
    EXPECT_FLOAT_EQ(picture.values[19], 1);
    EXPECT_NEAR(picture.values[3], 0.6, 1e-3);
    EXPECT_TRUE(std::isnan(picture.values[11]));
    EXPECT_EQ(picture.heights[11], 0);
}

TEST(TactilePicture, ListsNoMoreContactsThanAPersonReads) {
    BodyModel body;
    TactileHistory history(modulesUpTo(40));
    TactileSample sample = sampleAt(1s, modulesUpTo(40), 0);
    for (std::size_t i = 0; i < 40; ++i) {
        body.modules.emplace_back().id = ModuleId(static_cast<unsigned>(i + 1));
        sample.readings[i].force = {static_cast<float>((7 * i) % 40), 0, 0};
    }
    history.add(sample);
    TactilePicture picture;
    drawPicture(picture, history.at(0), Quantity::Proximity, body);
    ASSERT_EQ(picture.contacts.size(), kMostContacts);
    for (std::size_t i = 0; i < kMostContacts; ++i)
        EXPECT_EQ(picture.contacts[i].force, 39.0 - static_cast<double>(i));
}

TEST(TactilePicture, TracesLoseNoPeak) {
    const auto modules = modulesUpTo(2);
    TactileHistory history(modules);
    for (int i = 1; i <= 3000; ++i)
        history.add(sampleAt(i * 10ms, modules, i == 1234 ? 8.0F : 0.0F));
    for (const std::size_t whiles : {10U, 100U, 300U}) {
        Trace trace{ModuleId(2), {}};
        drawTrace(trace, history, Quantity::Force, whiles);
        ASSERT_EQ(trace.ranges.size(), whiles);
        const auto peaks = std::count_if(trace.ranges.begin(), trace.ranges.end(),
                                         [](const auto& range) { return range.second == 8; });
        EXPECT_EQ(peaks, 1);
        EXPECT_EQ(trace.ranges.back().second, 0);
    }
    Trace stranger{ModuleId(77), {}};
    drawTrace(stranger, history, Quantity::Force, 5);
    EXPECT_TRUE(std::isnan(stranger.ranges.front().first));
}

}  // namespace
}  // namespace skincal
