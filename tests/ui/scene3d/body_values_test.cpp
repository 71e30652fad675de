#include "ui/scene3d/body_values.h"

#include <gtest/gtest.h>
#include <vtkIdList.h>
#include <vtkPolyData.h>

#include "core/geometry/random.h"
#include "tests/ui/scene3d/sample_body.h"
#include "ui/scene3d/board_mesh.h"
#include "ui/scene3d/colour_map.h"
#include "ui/scene3d/scene_glyphs.h"

namespace skincal {
namespace {

TEST(BodyValues, UncertaintyIsThatOfTheWorstDirection) {
    const BodyModel body = sampleBody();
    const ModuleValues values = uncertainties_mm(body);
    for (std::size_t i = 0; i < body.modules.size(); ++i)
        EXPECT_NEAR(*values.values[i], 0.3 * (1 + 0.25 * body.modules[i].id.value), 1e-9);
    EXPECT_LE(values.low, *values.values.front());
    EXPECT_GT(values.high, values.low);
    for (std::size_t i = 1; i < body.modules.size(); ++i)
        EXPECT_GE(*values.share(i), *values.share(i - 1));
}

TEST(BodyValues, CountOnlyWhatWasUsed) {
    BodyModel body = sampleBody();
    body.views[1].observations[0].verdict = ObservationVerdict::Rejected;
    EXPECT_EQ(*viewCounts(body).values[0], 1);
    EXPECT_EQ(*viewCounts(body).values[1], 2);
    EXPECT_EQ(*lastViews(body).values[0], 0);
    EXPECT_EQ(*lastViews(body).values[1], 1);
    EXPECT_NEAR(*residuals_px(body).values[1], 0.04, 1e-12);
    body.views.clear();
    EXPECT_EQ(*viewCounts(body).values[0], 0);
    EXPECT_FALSE(lastViews(body).values[0]);
    EXPECT_FALSE(residuals_px(body).values[0]);
}

TEST(BodyValues, AreAbsentWhereNothingIsKnown) {
    const ModuleValues values = uncertainties_mm(sampleBodyWithoutPictures());
    for (std::size_t i = 0; i < values.values.size(); ++i)
        EXPECT_FALSE(values.share(i));
}

TEST(BodyValues, DeviationsAreSpreadEvenlyToBothSidesOfNothing) {
    const BodyModel body = sampleBody();
    std::map<ModuleId, double> deviations;
    for (std::size_t i = 1; i < body.modules.size(); ++i)
        deviations[body.modules[i].id] = i % 2 ? -0.4e-3 : 0.2e-3;
    const ModuleValues values = deviations_mm(body, deviations);
    EXPECT_FALSE(values.values[0]) << "of which nothing was said";
    EXPECT_NEAR(*values.values[1], -0.4, 1e-12);
    EXPECT_EQ(values.low, -values.high);
    EXPECT_NEAR(values.high, 0.4, 0.05);
    EXPECT_LT(*values.share(1), 0.1);
    EXPECT_NEAR(*values.share(2), 0.75, 0.05);
    EXPECT_EQ(deviations_mm(body, {}).low, -deviations_mm(body, {}).high);
}

TEST(DivergingColours, AreAsBrightToBothSidesAndBlueIsBelow) {
    const auto brightness = [](const Rgb& colour) { return 0.3 * colour[0] + 0.59 * colour[1] + 0.11 * colour[2]; };
    for (double away = 0.05; away <= 0.5; away += 0.05) {
        const Rgb below = divergingColour(0.5 - away);
        const Rgb above = divergingColour(0.5 + away);
        EXPECT_GT(below[2], above[2]) << away;
        EXPECT_LT(below[0], above[0]) << away;
        EXPECT_NEAR(brightness(below), brightness(above), 35) << away;
        EXPECT_LT(brightness(above), brightness(divergingColour(0.5 + away - 0.05))) << "darker outwards";
    }
    EXPECT_EQ(divergingColour(7), divergingColour(1));
}

TEST(Ellipsoids, HaveHalfAxesOfThreeStandardDeviationsAlongThePrincipalAxes) {
    Random random(11);
    for (int trial = 0; trial < 50; ++trial) {
        BodyModel body = sheetOf(1);
        BodyModule& module = body.modules[0];
        const Matrix3d V = so3Exp(Vector3d(random.normal(), random.normal(), random.normal()));
        const Vector3d sigma(random.uniform(0.1e-3, 1e-3), random.uniform(0.1e-3, 1e-3), random.uniform(0.1e-3, 1e-3));
        const Matrix3d position = V * sigma.cwiseAbs2().asDiagonal() * V.transpose();
        module.covariance->bottomRightCorner<3, 3>() = position;
        const double scale = random.uniform(10, 50);
        const auto mesh = ellipsoidsOf(body, scale, 100);
        ASSERT_GT(mesh->GetNumberOfPoints(), 0);
        // Faces look outwards, or they would not be drawn.
        auto corners = vtkSmartPointer<vtkIdList>::New();
        mesh->GetCellPoints(0, corners);
        const Vector3d a(mesh->GetPoint(corners->GetId(0)));
        const Vector3d b(mesh->GetPoint(corners->GetId(1)));
        const Vector3d c(mesh->GetPoint(corners->GetId(2)));
        EXPECT_GT((b - a).cross(c - a).dot(a - module.T_body_module->translation()), 0);
        double most = 0;
        for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i) {
            const Vector3d d = Vector3d(mesh->GetPoint(i)) - module.T_body_module->translation();
            EXPECT_NEAR(std::sqrt(d.dot(position.ldlt().solve(d))), 3 * scale, 1e-3 * scale);
            most = std::max(most, d.norm());
        }
        EXPECT_LE(most, 3 * scale * sigma.maxCoeff() * (1 + 1e-5));
        EXPECT_GE(most, 0.8 * 3 * scale * sigma.maxCoeff());
    }
}

TEST(Ellipsoids, CanBeSeenWhereTheyAreNeedles) {
    BodyModel body = sheetOf(1);
    body.modules[0].covariance->bottomRightCorner<3, 3>() = Vector3d(0, 0, 1e-6).asDiagonal();
    const auto mesh = ellipsoidsOf(body, 2, 1);
    double bounds[6];
    mesh->GetBounds(bounds);
    EXPECT_NEAR(bounds[1] - bounds[0], 1.6e-3, 1e-4);
    EXPECT_NEAR(bounds[5] - bounds[4], 2 * 3 * 2 * 1e-3, 1e-4);
}

TEST(Ellipsoids, AreOfTheWorstModulesWhereThereAreTooMany) {
    const BodyModel body = sheetOf(20);
    const auto one = ellipsoidsOf(body, 1, 1)->GetNumberOfPoints();
    EXPECT_EQ(ellipsoidsOf(body, 1, 5)->GetNumberOfPoints(), 5 * one);
    EXPECT_EQ(ellipsoidsOf(body, 1, 100)->GetNumberOfPoints(), 20 * one);
}

TEST(Ellipsoids, AreEnlargedByARoundNumberSoThatTheyFillTheirBoards) {
    for (const double factor : {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0}) {
        BodyModel body = sampleBody();
        for (BodyModule& module : body.modules)
            *module.covariance *= factor * factor;
        const double scale = ellipsoidScale(body);
        EXPECT_GE(scale, 1);
        double worst = 0;
        for (const BodyModule& module : body.modules)
            worst = std::max(worst, *worstSigma_mm(module));
        const double half_mm = 3 * scale * worst;
        if (scale > 1) {
            EXPECT_LT(half_mm, 20);
        }
        if (factor < 1) {
            EXPECT_GT(half_mm, 3);
        }
    }
}

TEST(ValueColour, GrowsBrighterWithTheValue) {
    for (const bool dark : {false, true}) {
        double last = -1;
        for (int i = 0; i <= 50; ++i) {
            const Rgb colour = valueColour(i / 50.0, dark);
            const double brightness = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
            EXPECT_GE(brightness, last);
            last = brightness;
        }
        EXPECT_EQ(valueColour(-1, dark), valueColour(0, dark));
        EXPECT_EQ(valueColour(2, dark), valueColour(1, dark));
    }
}

TEST(BoardMesh, ChangesColoursAndHeightsWithoutNewGeometry) {
    const BodyModel body = sheetOf(1000);
    const SceneLayout layout = layOut(body);
    BoardMesh mesh;
    mesh.build(layout);
    vtkPoints* points = mesh.data()->GetPoints();
    vtkCellArray* cells = mesh.data()->GetPolys();
    std::vector<Rgb> colours(1000, Rgb{1, 2, 3});
    std::vector<float> heights(1000, 0.002F);
    mesh.setColours(colours);
    mesh.setHeights(heights);
    EXPECT_EQ(mesh.data()->GetPoints(), points);
    EXPECT_EQ(mesh.data()->GetPolys(), cells);
    double bounds[6];
    points->ComputeBounds();
    points->GetBounds(bounds);
    EXPECT_NEAR(bounds[5], 0.002 + layout.modules[0].type->led.z(), 0.0005);
    colours.pop_back();
    EXPECT_THROW(mesh.setColours(colours), std::logic_error);
    heights.pop_back();
    EXPECT_THROW(mesh.setHeights(heights), std::logic_error);
}

}  // namespace
}  // namespace skincal
