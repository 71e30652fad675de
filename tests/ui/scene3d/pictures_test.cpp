#include <gtest/gtest.h>

#include <QFile>
#include <cstdlib>

#include "tests/ui/scene3d/baseline.h"
#include "tests/ui/scene3d/sample_body.h"
#include "tests/ui/scene3d/view_fixture.h"

namespace skincal {
namespace {

TEST(Pictures, OfTheBodyInEachTheme) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    EXPECT_TRUE(matchesBaseline(view->grabPicture(), "body-patches-dark"));
    view->setDark(false);
    EXPECT_TRUE(matchesBaseline(view->grabPicture(), "body-patches-light"));
}

TEST(Pictures, OfUncertaintyWithEllipsoids) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    view->setColourMode(ColourMode::Uncertainty);
    view->setEllipsoidsShown(true);
    EXPECT_TRUE(matchesBaseline(view->grabPicture(), "body-uncertainty-dark"));
}

TEST(Pictures, OfPatchesThatTakeShape) {
    const auto view = shownView();
    view->setDark(false);
    view->setBody(shared(sampleBodyWithoutPictures()));
    EXPECT_TRUE(matchesBaseline(view->grabPicture(), "patches-light"));
}

TEST(Pictures, OfGuidesAndSelection) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    view->setSelected({ModuleId(3), ModuleId(12)});
    view->setGuideUp(Vector3d(0, 1, 0.2));
    Isometry3d T_r_v = *sampleBody().views[0].T_body_camera;
    T_r_v.translation().x() += 0.2;
    view->setGuideCamera(T_r_v);
    view->fitEverything();
    EXPECT_TRUE(matchesBaseline(view->grabPicture(), "guides-dark"));
}

TEST(Pictures, OfTouchWithContacts) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    view->setCamerasShown(false);
    view->setColourMode(ColourMode::Values);
    std::vector<float> values;
    std::vector<float> heights;
    for (std::size_t u = 0; u < view->body()->modules.size(); ++u) {
        values.push_back(static_cast<float>(u % 5) / 4);
        heights.push_back(0.004F * values.back());
    }
    view->setCellValues(values);
    view->setCellHeights(heights);
    view->setContacts(contactsOn(*view, {3, 12}));
    EXPECT_TRUE(matchesBaseline(view->grabPicture(), "touch-dark"));
}

TEST(Pictures, OfDeviationsFromAMesh) {
    const auto view = shownView();
    view->setDark(false);
    view->setBody(shared(sampleBody()));
    std::map<ModuleId, double> deviations;
    for (const BodyModule& module : view->body()->modules)
        deviations[module.id] = 1e-3 * (static_cast<double>(module.id.value % 7) - 3);
    view->setDeviations(std::move(deviations));
    view->setColourMode(ColourMode::Deviation);
    EXPECT_TRUE(matchesBaseline(view->grabPicture(), "deviations-light"));
}

TEST(Pictures, OfNothing) {
    const auto view = shownView();
    EXPECT_TRUE(matchesBaseline(view->grabPicture(), "empty-dark"));
}

TEST(Pictures, WithoutABaselineFail) {
    if (std::getenv("SKINCAL_UPDATE_BASELINES") != nullptr)
        GTEST_SKIP() << "it would be written";
    EXPECT_FALSE(matchesBaseline(QImage(48, 36, QImage::Format_RGB32), "there-is-none"));
    QFile::remove("there-is-none-drawn.png");
}

TEST(Pictures, DifferWhereTheSceneDoes) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    const QImage patches = view->grabPicture();
    EXPECT_LT(unlikeness(patches, view->grabPicture()), 1e-3);
    view->setColourMode(ColourMode::Residual);
    EXPECT_GT(unlikeness(patches, view->grabPicture()), 0.02);
    EXPECT_GT(unlikeness(patches, QImage(100, 100, QImage::Format_RGB32)), 0.99);
}

}  // namespace
}  // namespace skincal
