#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include "core/formats/export_csv.h"
#include "core/formats/export_ply.h"
#include "core/formats/export_urdf.h"
#include "core/geometry/random.h"

namespace skincal {
namespace {

BodyModel oneModule(const Isometry3d& T) {
    BodyModel body;
    body.templates = {paperHexagon()};
    body.modules.resize(1);
    body.modules[0].id = ModuleId(1);
    body.modules[0].type = "hex";
    body.modules[0].T_body_module = T;
    return body;
}

TEST(ExportUrdf, PosesAreExactAtAndNearGimbalLock) {
    Random random(7, "GimbalLock");
    for (const double sign : {-1.0, 1.0}) {
        for (const double off : {0.0, 1e-16, 1e-12, 1e-10, 1e-9, 3e-9, 1e-8, 1e-6, 1e-3}) {
            for (int i = 0; i < 20; ++i) {
                const Matrix3d R = (Eigen::AngleAxisd(random.uniform(-3.1, 3.1), Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(sign * (1.5707963267948966 - off), Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(random.uniform(-3.1, 3.1), Vector3d::UnitX()))
                                       .toRotationMatrix();
                const Vector3d t(0.1, -1e-12, 1e5);
                const auto robot = urdf::parseURDF(exportUrdf(oneModule(makeIsometry(R, t))));
                ASSERT_TRUE(robot);
                const urdf::Pose& pose = robot->getLink("module_1")->parent_joint->parent_to_joint_origin_transform;
                const Quaterniond q(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
                EXPECT_LT((q.toRotationMatrix() - R).cwiseAbs().maxCoeff(), 1e-14) << "off " << off;
                EXPECT_EQ(Vector3d(pose.position.x, pose.position.y, pose.position.z), t);
            }
        }
    }
}

TEST(ExportUrdf, ModulesAreBoxesOfTheirSize) {
    const auto robot = urdf::parseURDF(exportUrdf(oneModule(Isometry3d::Identity())));
    ASSERT_TRUE(robot);
    const auto visual = robot->getLink("module_1")->visual;
    ASSERT_TRUE(visual);
    const auto box = std::dynamic_pointer_cast<urdf::Box>(visual->geometry);
    ASSERT_TRUE(box);
    const auto& outline = paperHexagon().outline;
    double width = 0;
    for (const Vector2d& p : outline)
        width = std::max(width, 2 * p.x());
    EXPECT_NEAR(box->dim.x, width, 1e-6);
    EXPECT_GT(box->dim.z, 0);
    EXPECT_NEAR(visual->origin.position.z, -0.5 * box->dim.z, 1e-12) << "below the skin's surface";
}

TEST(ExportUrdf, AModuleOfNoTypeHasNoShape) {
    BodyModel body = oneModule(Isometry3d::Identity());
    body.templates.clear();
    const auto robot = urdf::parseURDF(exportUrdf(body));
    ASSERT_TRUE(robot);
    EXPECT_FALSE(robot->getLink("module_1")->visual);
}

TEST(ExportUrdf, NamesAreEscaped) {
    const std::string name = "<a> & \"b\" 'c'";
    const auto robot = urdf::parseURDF(exportUrdf(oneModule(Isometry3d::Identity()), name));
    ASSERT_TRUE(robot);
    EXPECT_EQ(robot->getName(), name);
    EXPECT_THAT(exportUrdf(BodyModel{}, "a\x01\nb"), testing::HasSubstr("robot name=\"a  b\""));
}

TEST(ExportCsv, TextsCannotBreakTheTable) {
    BodyModel body = oneModule(Isometry3d::Identity());
    body.modules[0].T_body_module.reset();
    body.modules[0].type = "a,b\"c";
    body.modules[0].status = Sentence::verbatim("d\r\ne,f");
    EXPECT_THAT(exportCsv(body), testing::EndsWith("\n1,a;b;c,,d;;e;f,,,,,,,\n"));
}

TEST(ExportPly, CountsOfLongOutlinesFit) {
    BodyModel body = oneModule(Isometry3d::Identity());
    EXPECT_THAT(exportPly(body), testing::HasSubstr("property list uchar int vertex_indices\n"));
    body.templates[0].outline.assign(300, Vector2d::Zero());
    EXPECT_THAT(exportPly(body), testing::HasSubstr("property list uint int vertex_indices\n"));
    EXPECT_THAT(exportPly(body), testing::HasSubstr("\n300 0 1 2 "));
}

}  // namespace
}  // namespace skincal
