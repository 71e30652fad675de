#include "tests/ui/window/true_body.h"

#include <gtest/gtest.h>

#include "core/estimation/compare.h"
#include "core/formats/body_json.h"

namespace skincal {
namespace {

BodyComparison comparedWithTruth(const BodyModel& body, const World& world) {
    std::vector<NamedPose> ours;
    std::vector<NamedPose> truth;
    for (const BodyModule& module : body.modules) {
        if (module.T_body_module)
            ours.push_back({module.id, *module.T_body_module});
    }
    for (std::size_t u = 0; u < world.skin.modules.size(); ++u)
        truth.push_back({world.skin.modules[u].id, world.T_r_u[u]});
    return compareBodies(ours, truth).value();
}

}  // namespace

void expectTrueBody(const QString& file, const World& world) {
    const auto body = readBody(file.toStdString());
    ASSERT_TRUE(body) << body.error().message();
    const BodyComparison difference = comparedWithTruth(*body, world);
    EXPECT_EQ(difference.compared, world.skin.modules.size());
    EXPECT_LT(difference.positionRms, 1e-3);
    EXPECT_LT(difference.rotationRms, 1.5 * kDegree);
}

}  // namespace skincal
