#include "core/skin/module_template.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/formats/template_json.h"

namespace skincal {
namespace {

double signedArea(const std::vector<Vector2d>& outline) {
    double area = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vector2d& p = outline[i];
        const Vector2d& q = outline[(i + 1) % outline.size()];
        area += 0.5 * (p.x() * q.y() - p.y() * q.x());
    }
    return area;
}

bool isInside(const std::vector<Vector2d>& outline, const Vector2d& point) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vector2d edge = outline[(i + 1) % outline.size()] - outline[i];
        const Vector2d to = point - outline[i];
        if (edge.x() * to.y() - edge.y() * to.x() < 0)
            return false;
    }
    return true;
}

class Templates : public testing::TestWithParam<ModuleTemplate> {};

TEST_P(Templates, AreConvexBoardsWithPortsJustOutside) {
    const ModuleTemplate& type = GetParam();
    EXPECT_GT(signedArea(type.outline), 0) << "clockwise";
    EXPECT_TRUE(isInside(type.outline, type.led.head<2>()));
    EXPECT_TRUE(isInside(type.outline, Vector2d::Zero()));
    for (const SensorSite& sensor : type.sensors)
        EXPECT_TRUE(isInside(type.outline, sensor.position.head<2>())) << sensor.kind;
    for (const Vector3d& port : type.ports) {
        EXPECT_FALSE(isInside(type.outline, port.head<2>())) << port.transpose();
        EXPECT_TRUE(isInside(type.outline, 0.9 * port.head<2>())) << port.transpose();
        EXPECT_LE(port.norm(), type.portRadius());
    }
}

INSTANTIATE_TEST_SUITE_P(All, Templates, testing::Values(paperHexagon(), triangleTemplate(), rectangleTemplate()),
                         [](const auto& test) { return test.param.name; });

TEST(PaperHexagon, HasThePapersPitch) {
    const ModuleTemplate hexagon = paperHexagon();
    EXPECT_NEAR(hexagon.portRadius(), 0.222277 / 8 / 2, 1e-6);
    EXPECT_EQ(hexagon.led, Vector3d(0.0079, 0, 0));
}

TEST(PortRadius, IsThatOfTheFarthestPort) {
    ModuleTemplate type;
    EXPECT_EQ(type.portRadius(), 0);
    type.ports = {{0.003, 0, 0.004}, {0.001, 0, 0}};
    EXPECT_DOUBLE_EQ(type.portRadius(), 0.005);
}

struct Shipped {
    const char* file;
    ModuleTemplate type;
};

class ShippedTemplates : public testing::TestWithParam<Shipped> {};

TEST_P(ShippedTemplates, AreTheBuiltInOnes) {
    const std::filesystem::path file = std::filesystem::path(SKINCAL_RESOURCES) / "templates" / GetParam().file;
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    ASSERT_FALSE(text.str().empty()) << file;
    const nlohmann::json json = parseJson(text.str(), file);
    const ModuleTemplate read = readTemplate(JsonCursor(json, file));
    const ModuleTemplate& type = GetParam().type;
    EXPECT_EQ(read.name, type.name);
    EXPECT_EQ(read.outline, type.outline);
    EXPECT_EQ(read.led, type.led);
    EXPECT_EQ(read.ports, type.ports);
    EXPECT_EQ(read.accelerometer, type.accelerometer);
    ASSERT_EQ(read.sensors.size(), type.sensors.size());
    for (std::size_t i = 0; i < type.sensors.size(); ++i) {
        EXPECT_EQ(read.sensors[i].kind, type.sensors[i].kind);
        EXPECT_EQ(read.sensors[i].position, type.sensors[i].position);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedTemplates,
                         testing::Values(Shipped{"hexagon.json", paperHexagon()},
                                         Shipped{"triangle.json", triangleTemplate()},
                                         Shipped{"rectangle.json", rectangleTemplate()}),
                         [](const auto& test) { return test.param.type.name; });

}  // namespace
}  // namespace skincal
