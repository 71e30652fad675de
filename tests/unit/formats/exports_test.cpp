#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <sstream>

#include "core/formats/export_csv.h"
#include "core/formats/export_ply.h"
#include "core/formats/export_urdf.h"
#include "tests/unit/formats/random_body.h"

namespace skincal {
namespace {

Isometry3d toIsometry(const urdf::Pose& pose) {
    const Quaterniond q(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
    return makeIsometry(q.normalized().toRotationMatrix(), {pose.position.x, pose.position.y, pose.position.z});
}

/// Pose of a link in the root, through whatever joints lead there.
Isometry3d inRoot(const urdf::ModelInterface& model, const std::string& name) {
    Isometry3d T = Isometry3d::Identity();
    for (auto link = model.getLink(name); link && link->parent_joint; link = link->getParent())
        T = toIsometry(link->parent_joint->parent_to_joint_origin_transform) * T;
    return T;
}

TEST(ExportUrdf, SomebodyElsesParserFindsEveryModuleWhereItIs) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        BodyModel body = test::randomBody(seed);
        // Straight up: the roll-pitch-yaw angles lose a degree of freedom there.
        body.modules[2].T_body_module->linear() = body.patches[0].T_body_patch->linear() *
                                                  Eigen::AngleAxisd(90 * kDegree, Vector3d::UnitY()).toRotationMatrix();
        const auto model = urdf::parseURDF(exportUrdf(body, "skin & <bones>"));
        ASSERT_TRUE(model);
        EXPECT_EQ(model->getRoot()->name, "skin_base");
        for (const BodyModule& module : body.modules) {
            const std::string name = "module_" + std::to_string(module.id.value);
            ASSERT_EQ(model->getLink(name) != nullptr, module.T_body_module.has_value());
            if (module.T_body_module) {
                EXPECT_TRUE(inRoot(*model, name).isApprox(*module.T_body_module, 1e-6));
            }
        }
    }
}

TEST(ExportCsv, HasARowPerModuleAndNumbersForThoseThatArePlaced) {
    const BodyModel body = test::randomBody(4);
    std::istringstream csv(exportCsv(body));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line, "id,type,patch,status,x,y,z,qx,qy,qz,qw");
    for (const BodyModule& module : body.modules) {
        ASSERT_TRUE(std::getline(csv, line));
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 10);
        EXPECT_EQ(std::stoul(line), module.id.value);
        EXPECT_EQ(line.find(",,,,,,") == std::string::npos, module.T_body_module.has_value());
        EXPECT_EQ(line.find('"'), std::string::npos);
    }
    EXPECT_FALSE(std::getline(csv, line));
}

TEST(ExportPly, HasTheCornersOfEveryPlacedBoard) {
    const BodyModel body = test::randomBody(5);
    const std::string ply = exportPly(body);
    // Three hexagons and two triangles are placed.
    EXPECT_THAT(ply, testing::HasSubstr("element vertex 24\n"));
    EXPECT_THAT(ply, testing::HasSubstr("element face 5\n"));
    std::istringstream lines(ply.substr(ply.find("end_header\n") + 11));
    double x = 0;
    double y = 0;
    double z = 0;
    lines >> x >> y >> z;
    const Vector2d corner = paperHexagon().outline[0];
    EXPECT_LT((Vector3d(x, y, z) - *body.modules[0].T_body_module * Vector3d(corner.x(), corner.y(), 0)).norm(), 1e-6);
}

TEST(Exports, ABodyWithoutModulesGivesFilesThatStillLoad) {
    const BodyModel empty;
    EXPECT_TRUE(urdf::parseURDF(exportUrdf(empty)));
    EXPECT_THAT(exportPly(empty), testing::HasSubstr("element face 0\n"));
    EXPECT_EQ(exportCsv(empty), "id,type,patch,status,x,y,z,qx,qy,qz,qw\n");
}

}  // namespace
}  // namespace skincal
