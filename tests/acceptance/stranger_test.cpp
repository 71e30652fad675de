// A skin that somebody wrote in Python who had nothing but the protocol's specification: resources/bridges.

#include <gtest/gtest.h>

#include <QFile>
#include <QRegularExpression>
#include <QTemporaryDir>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "core/device/protocol_skin.h"
#include "tests/acceptance/program.h"
#include "tests/wait_for.h"

namespace skincal::test {
namespace {

nlohmann::json explored(const std::string& arguments) {
    const Outcome outcome =
        run("explore --json 'exec:python3 " SKINCAL_SOURCES "/tests/acceptance/stranger_skin.py " + arguments + "'");
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.output, nullptr, false);
}

void expectAChain(const nlohmann::json& skin, std::size_t cells) {
    ASSERT_TRUE(skin.is_object());
    EXPECT_EQ(skin["modules"].size(), cells);
    EXPECT_EQ(skin["links"].size(), cells - 1);
    EXPECT_EQ(skin["host_links"].size(), 1U);
    EXPECT_TRUE(skin["silent_cells"].empty());
    std::map<unsigned, std::string> uniqueIds;
    for (const auto& module : skin["modules"]) {
        EXPECT_EQ(module["type"], "hex");
        uniqueIds[module["id"]] = module["unique_id"];
    }
    std::set<std::string> ids;
    for (const auto& [id, uniqueId] : uniqueIds)
        ids.insert(uniqueId);
    EXPECT_EQ(ids.size(), cells);
    for (const auto& link : skin["links"])
        EXPECT_EQ(int(link["a_port"]) + int(link["b_port"]), 2) << "from port 2 of one to port 0 of the next";
}

TEST(Stranger, IsUnderstood) {
    expectAChain(explored("7"), 7);
    expectAChain(explored("300"), 300);
}

TEST(Stranger, OnABadLineToo) {
    for (int seed = 1; seed <= 3; ++seed)
        expectAChain(explored("60 --drop 0.05 --flip 0.001 --seed " + std::to_string(seed)), 60);
}

/// The application's side of it, and what the stranger says that it does.
class SpokenTo {
  public:
    /// @param command  with %1 for the file that tells what the LEDs show
    explicit SpokenTo(const QString& command)
        : log_(directory_.filePath(QStringLiteral("leds"))),
          device(parseLineAddress(QStringLiteral("exec:") + command.arg(log_)).value(), {paperHexagon()}) {
        QObject::connect(&device, &SkinDevice::opened, &device, [this] { device.explore(); });
        QObject::connect(&device, &SkinDevice::failed, &device, [this](const QString& why) { failure = why; });
        QObject::connect(&device, &SkinDevice::explored, &device, [this](const Skin& skin) {
            for (const SkinModule& module : skin.modules) {
                modules.push_back(module.id);
                // The last four bytes say which cell it is.
                cellOf[module.id] = std::stoul(module.uniqueId.substr(16), nullptr, 16);
            }
        });
        QObject::connect(&device, &SkinDevice::lightShown, &device, [this](std::uint64_t token) { shown = token; });
        device.open();
    }

    /// Cells by what the stranger's LEDs show, 0xRRGGBB.
    [[nodiscard]] std::map<std::size_t, int> lit() const {
        std::map<std::size_t, int> lit;
        QFile file(log_);
        if (!file.open(QIODevice::ReadOnly))
            return lit;
        static const QRegularExpression kChange(QStringLiteral(R"(\((\d+), \((\d+), (\d+), (\d+)\)\))"));
        auto changes = kChange.globalMatch(QString::fromLatin1(file.readAll()));
        while (changes.hasNext()) {
            const auto change = changes.next();
            const auto part = [&](int i) { return change.captured(i).toInt(); };
            lit[change.captured(1).toULong()] = part(2) << 16 | part(3) << 8 | part(4);
        }
        std::erase_if(lit, [](const auto& one) { return one.second == 0; });
        return lit;
    }

  private:
    QTemporaryDir directory_;
    QString log_;

  public:
    ProtocolSkin device;
    std::vector<ModuleId> modules;
    std::map<ModuleId, std::size_t> cellOf;
    std::optional<QString> failure;
    std::uint64_t shown = 0;
};

/// @param g  m/s^2, as its driver counts
void expectEverything(const QString& command, double g = 9.81) {
    SpokenTo stranger(command);
    ProtocolSkin& device = stranger.device;
    ASSERT_TRUE(waitFor([&] { return !stranger.modules.empty() || stranger.failure; }));
    ASSERT_FALSE(stranger.failure) << stranger.failure->toStdString();

    std::mt19937 random(3);
    std::vector<std::vector<LitModule>> sets(12);
    for (std::size_t k = 0; k < sets.size(); ++k)
        for (const ModuleId module : stranger.modules)
            if (random() % 2 == 0)
                sets[k].push_back({module, k == 5 ? std::optional(std::array{1, 0, 1}) : std::nullopt});
    sets.push_back({});
    sets.push_back({{stranger.modules.back(), std::nullopt}});
    device.prepare({sets.begin(), sets.begin() + 5});
    for (std::size_t k = 0; k < sets.size(); ++k) {
        const std::uint64_t token =
            k % 2 == 0 ? device.light(sets[k]) : device.lightAt(sets[k], *device.now() + std::chrono::milliseconds(30));
        ASSERT_TRUE(waitFor([&] { return stranger.shown == token; })) << k;
        std::map<std::size_t, int> expected;
        for (const LitModule& one : sets[k])
            expected[stranger.cellOf.at(one.module)] = one.colour ? 0xFF00FF : 0xFFFFFF;
        EXPECT_EQ(stranger.lit(), expected) << k;
    }

    std::map<ModuleId, Vector3d> read;
    QObject::connect(&device, &SkinDevice::accelerationArrived, &device, [&](const AccelerationSample& sample) {
        for (const auto& reading : sample.readings)
            read[reading.module] = reading.acceleration;
    });
    device.streamAcceleration(true);
    ASSERT_TRUE(waitFor([&] { return read.size() == stranger.modules.size(); }));
    for (const auto& [module, acceleration] : read) {
        const double angle = 0.1 + 0.01 * static_cast<double>(stranger.cellOf.at(module));
        EXPECT_LT((acceleration - g * Vector3d(std::sin(angle), 0, std::cos(angle))).norm(), 1e-3);
    }
    std::map<ModuleId, TactileSample::Reading> felt;
    QObject::connect(&device, &SkinDevice::tactileArrived, &device, [&](const TactileSample& sample) {
        for (const auto& reading : sample.readings)
            felt[reading.module] = reading;
    });
    device.streamTactile(true);
    ASSERT_TRUE(waitFor([&] { return felt.size() == stranger.modules.size(); }));
    for (const auto& [module, reading] : felt) {
        EXPECT_NEAR(reading.proximity, 0.5, 1e-3);
        EXPECT_NEAR(reading.force[2], 0.3, 1e-3);
        EXPECT_NEAR(reading.temperature, 30, 1e-2);
    }
    device.close();
    EXPECT_TRUE(waitFor([&] { return stranger.lit().empty(); }));
}

const QString kStranger = QStringLiteral("python3 " SKINCAL_SOURCES "/tests/acceptance/stranger_skin.py --log %1 ");

TEST(Stranger, LightsMeasuresAndFeelsAsItIsTold) {
    expectEverything(kStranger + QStringLiteral("30"));
}

TEST(Stranger, LightsMeasuresAndFeelsOnABadLineToo) {
    expectEverything(kStranger + QStringLiteral("30 --ring --drop 0.03 --flip 0.0005"));
}

// The example for somebody else's driver, which a stub of ROS stands for.
TEST(RosBridge, PassesOnWhatADriverOffers) {
    expectEverything(QStringLiteral("env FAKE_ROS_LEDS=%1 PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=" SKINCAL_SOURCES
                                    "/tests/acceptance/fake_ros python3 " SKINCAL_SOURCES
                                    "/resources/bridges/tum_ros_bridge.py --topic /patch1"),
                     9.80665);
}

TEST(RosBridge, SaysWhatIsMissing) {
    const Outcome outcome = run("explore 'exec:python3 " SKINCAL_SOURCES "/resources/bridges/tum_ros_bridge.py'");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.error.find("Source the setup.bash of ROS 1"), std::string::npos) << outcome.error;
}

}  // namespace
}  // namespace skincal::test
