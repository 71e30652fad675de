// Where arrow keys lead in drawings of modules.

#include <gtest/gtest.h>

#include <set>

#include "core/geometry/random.h"
#include "ui/widgets/module_keys.h"

namespace skincal {
namespace {

constexpr std::array kArrows{Qt::Key_Left, Qt::Key_Right, Qt::Key_Up, Qt::Key_Down};

std::vector<ModulePlace> scattered(std::size_t count, std::uint64_t seed) {
    Random random(seed, "places of modules");
    std::vector<ModulePlace> places;
    for (std::size_t i = 0; i < count; ++i)
        places.push_back(
            {ModuleId{static_cast<std::uint32_t>(10 + i)}, QPointF(random.uniform(0, 600), random.uniform(0, 400))});
    return places;
}

/// Neighbours side by side, as on a patch.
std::vector<ModulePlace> hexagons() {
    std::vector<ModulePlace> places;
    for (std::uint32_t row = 0; row < 5; ++row) {
        for (std::uint32_t column = 0; column < 6; ++column)
            places.push_back({ModuleId{6 * row + column}, QPointF(28 * column + 14 * (row % 2), 24 * row)});
    }
    return places;
}

QPointF placeOf(const std::vector<ModulePlace>& places, ModuleId module) {
    return std::find_if(places.begin(), places.end(), [&](const ModulePlace& p) { return p.module == module; })->at;
}

TEST(ModuleKeys, ArrowsLeadInTheirDirectionOrStay) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto places = scattered(30, seed);
        for (const ModulePlace& from : places) {
            for (const Qt::Key key : kArrows) {
                const ModuleId to = moduleByKey(key, places, from.module).value();
                const QPointF way = placeOf(places, to) - from.at;
                if (to == from.module)
                    continue;
                const double ahead = key == Qt::Key_Left    ? -way.x()
                                     : key == Qt::Key_Right ? way.x()
                                     : key == Qt::Key_Up    ? -way.y()
                                                            : way.y();
                EXPECT_GT(ahead, 0);
            }
        }
    }
}

TEST(ModuleKeys, ArrowsReachEveryModuleOfAPatch) {
    const auto places = hexagons();
    std::set<ModuleId> reached{places.front().module};
    for (std::vector<ModuleId> edge(reached.begin(), reached.end()); !edge.empty();) {
        const ModuleId from = edge.back();
        edge.pop_back();
        for (const Qt::Key key : kArrows) {
            if (const ModuleId to = moduleByKey(key, places, from).value(); reached.insert(to).second)
                edge.push_back(to);
        }
    }
    EXPECT_EQ(reached.size(), places.size());
    EXPECT_EQ(moduleByKey(Qt::Key_Right, places, ModuleId{0}), ModuleId{1}) << "the neighbour, not one of the next row";
    EXPECT_EQ(moduleByKey(Qt::Key_Left, places, ModuleId{0}), ModuleId{0}) << "there is nothing";
}

TEST(ModuleKeys, PageKeysGoByNumberThroughAll) {
    const auto places = scattered(12, 3);
    std::optional<ModuleId> at = moduleByKey(Qt::Key_PageDown, places, std::nullopt);
    EXPECT_EQ(at, places.front().module) << "the first comes first";
    for (std::size_t i = 1; i < places.size(); ++i) {
        at = moduleByKey(Qt::Key_PageDown, places, at);
        EXPECT_EQ(at, places[i].module);
    }
    EXPECT_EQ(moduleByKey(Qt::Key_PageDown, places, at), at);
    EXPECT_EQ(moduleByKey(Qt::Key_PageUp, places, at), places[places.size() - 2].module);
    EXPECT_EQ(moduleByKey(Qt::Key_Home, places, at), places.front().module);
    EXPECT_EQ(moduleByKey(Qt::Key_End, places, std::nullopt), places.back().module);
}

TEST(ModuleKeys, OtherKeysAndEmptyDrawingsLeadNowhere) {
    EXPECT_EQ(moduleByKey(Qt::Key_Right, {}, std::nullopt), std::nullopt);
    EXPECT_EQ(moduleByKey(Qt::Key_Return, hexagons(), ModuleId{1}), std::nullopt);
    EXPECT_EQ(moduleByKey(Qt::Key_Left, hexagons(), ModuleId{999}), ModuleId{0}) << "what has gone is begun anew";
}

}  // namespace
}  // namespace skincal
