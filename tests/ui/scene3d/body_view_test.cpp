#include <gtest/gtest.h>
#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>

#include <QMainWindow>
#include <QMouseEvent>
#include <QVBoxLayout>

#include "tests/ui/scene3d/baseline.h"
#include "tests/ui/scene3d/sample_body.h"
#include "tests/ui/scene3d/view_fixture.h"
#include "ui/scene3d/scene_overlay.h"
#include "ui/scene3d/scene_widget.h"

namespace skincal {
namespace {

void mouse(BodyViewWidget& view, QEvent::Type type, const QPointF& at, Qt::MouseButtons buttons) {
    QMouseEvent event(type, at, view.mapToGlobal(at), Qt::LeftButton, buttons, Qt::NoModifier);
    QApplication::sendEvent(&view.scene(), &event);
}

void click(BodyViewWidget& view, const QPointF& at) {
    mouse(view, QEvent::MouseButtonPress, at, Qt::LeftButton);
    mouse(view, QEvent::MouseButtonRelease, at, Qt::NoButton);
}

void press(BodyViewWidget& view, int key) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier);
    QApplication::sendEvent(&view, &event);
}

Vector3d eyeOf(const BodyViewWidget& view) {
    return Vector3d(view.scene().renderer().GetActiveCamera()->GetPosition());
}

TEST(BodyView, ClickPicksTheModuleThatIsDrawnThere) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    // Each board in turn painted white, all others black: what is seen at a place is what a click there must hit.
    view->setColourMode(ColourMode::Values);
    view->setCamerasShown(false);
    std::vector<ModuleId> clicked;
    QObject::connect(view.get(), &BodyViewWidget::moduleClicked, [&](ModuleId id) { clicked.push_back(id); });
    int checked = 0;
    for (const ShownModule& module : view->layoutShown().modules) {
        // A place without the LED.
        const auto at = view->positionOf(module.T_s_u * Vector3d(-0.004, 0.002, 0));
        ASSERT_TRUE(at);
        std::vector<float> values(view->body()->modules.size(), 0.0F);
        values[module.index] = 1.0F;
        view->setCellValues(values);
        const QColor seen = view->grabPicture().pixelColor(at->toPoint());
        const bool shines = seen.red() > 120 && seen.green() > 110;
        clicked.clear();
        click(*view, *at);
        if (shines) {
            ++checked;
            EXPECT_EQ(clicked, std::vector<ModuleId>{module.id});
        } else {
            EXPECT_TRUE(clicked.empty() || clicked[0] != module.id || module.T_s_u.linear()(2, 2) < 0.3);
        }
    }
    EXPECT_GE(checked, 10);
}

TEST(BodyView, ClickBesideTheBodyPicksNothing) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    int beside = 0;
    int hit = 0;
    QObject::connect(view.get(), &BodyViewWidget::nothingClicked, [&] { ++beside; });
    QObject::connect(view.get(), &BodyViewWidget::moduleClicked, [&] { ++hit; });
    click(*view, QPointF(470, 8));
    EXPECT_EQ(beside, 1);
    EXPECT_EQ(hit, 0);
    // A drag is no click.
    mouse(*view, QEvent::MouseButtonPress, {240, 180}, Qt::LeftButton);
    mouse(*view, QEvent::MouseMove, {280, 200}, Qt::LeftButton);
    mouse(*view, QEvent::MouseButtonRelease, {280, 200}, Qt::NoButton);
    EXPECT_EQ(hit, 0);
}

TEST(BodyView, MeasuresBetweenTwoLeds) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    view->setMeasuring(true);
    double distance = 0;
    int selected = 0;
    QObject::connect(view.get(), &BodyViewWidget::measured, [&](ModuleId, ModuleId, double d) { distance = d; });
    QObject::connect(view.get(), &BodyViewWidget::moduleClicked, [&] { ++selected; });
    const SceneLayout& layout = view->layoutShown();
    click(*view, *view->positionOf(layout.find(ModuleId(2))->T_s_u.translation()));
    click(*view, *view->positionOf(layout.find(ModuleId(5))->T_s_u.translation()));
    EXPECT_NEAR(distance, (layout.find(ModuleId(2))->led() - layout.find(ModuleId(5))->led()).norm(), 1e-12);
    EXPECT_EQ(selected, 0);
    EXPECT_EQ(view->overlay().content().measure.size(), 2U);
    press(*view, Qt::Key_Escape);
    EXPECT_TRUE(view->overlay().content().measure.empty());
}

TEST(BodyView, SaysThatThereIsNothingYet) {
    const auto view = shownView();
    EXPECT_FALSE(view->overlay().content().empty.isEmpty());
    view->setBody(shared(sampleBodyWithoutPictures()));
    EXPECT_TRUE(view->overlay().content().empty.isEmpty());
    EXPECT_FALSE(view->overlay().content().caption.isEmpty());
    view->setBody(shared(sampleBody()));
    EXPECT_TRUE(view->overlay().content().caption.isEmpty());
    view->setBody(nullptr);
    EXPECT_FALSE(view->overlay().content().empty.isEmpty());
    view->setBody(shared(BodyModel{}));
    EXPECT_FALSE(view->overlay().content().empty.isEmpty());
    EXPECT_FALSE(view->accessibleName().isEmpty());
    EXPECT_FALSE(view->toolTip().isEmpty());
}

TEST(BodyView, KeepsTheUsersCameraFromSnapshotToSnapshot) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    press(*view, Qt::Key_Left);
    press(*view, Qt::Key_Plus);
    const Vector3d eye = eyeOf(*view);
    BodyModel more = sampleBody();
    more.modules.pop_back();
    view->setBody(shared(more));
    EXPECT_EQ(eyeOf(*view), eye);
    press(*view, Qt::Key_Home);
    EXPECT_NE(eyeOf(*view), eye);
    const Vector3d front = eyeOf(*view);
    press(*view, Qt::Key_Left);
    view->setBody(nullptr);
    view->setBody(shared(sampleBody()));
    EXPECT_NE(eyeOf(*view), eye);
    EXPECT_GT((front - eye).norm(), 0.01);
}

TEST(BodyView, KeysTurnAndZoomAndFit) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    vtkCamera* camera = view->scene().renderer().GetActiveCamera();
    const double distance = camera->GetDistance();
    for (const int key : {Qt::Key_Left, Qt::Key_Right, Qt::Key_Up, Qt::Key_Down}) {
        const Vector3d before = eyeOf(*view);
        press(*view, key);
        EXPECT_GT((eyeOf(*view) - before).norm(), 0.01);
        EXPECT_NEAR(camera->GetDistance(), distance, 1e-6);
    }
    press(*view, Qt::Key_Plus);
    EXPECT_LT(camera->GetDistance(), distance);
    press(*view, Qt::Key_F);
    for (const Vector3d& corner : view->layoutShown().corners()) {
        const auto at = view->positionOf(corner);
        ASSERT_TRUE(at);
        EXPECT_TRUE(QRectF(view->rect()).contains(*at));
    }
}

TEST(BodyView, DrawsOnlyWhenSomethingChangesAndNotMoreThanThirtyTimesASecond) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    spin(600);
    const int before = view->scene().framesDrawn();
    spin(300);
    EXPECT_EQ(view->scene().framesDrawn(), before);
    QElapsedTimer timer;
    timer.start();
    while (timer.elapsed() < 600) {
        view->scene().requestDraw();
        QApplication::processEvents();
    }
    const int drawn = view->scene().framesDrawn() - before;
    EXPECT_GE(drawn, 1);
    EXPECT_LE(drawn, static_cast<int>(timer.elapsed() / 33) + 2);
}

TEST(BodyView, MayBeDestroyedAtAnyTime) {
    for (int moment = 0; moment < 5; ++moment) {
        QMainWindow window;
        auto* view = new BodyViewWidget;
        window.setCentralWidget(view);
        if (moment >= 1)
            view->setBody(shared(sampleBody()));
        if (moment >= 2)
            window.show();
        if (moment >= 3)
            spin(60);
        if (moment == 4) {
            mouse(*view, QEvent::MouseButtonPress, {100, 100}, Qt::LeftButton);
            mouse(*view, QEvent::MouseMove, {140, 120}, Qt::LeftButton);
            delete view;
            spin(50);
        }
    }
}

TEST(BodyView, MayMoveToAnotherWindow) {
    QMainWindow first;
    first.resize(480, 360);
    auto* view = new BodyViewWidget;
    first.setCentralWidget(view);
    first.show();
    view->setBody(shared(sampleBody()));
    spin(80);
    const QImage before = view->grabPicture();
    QMainWindow second;
    second.resize(480, 360);
    view->setParent(nullptr);
    second.setCentralWidget(view);
    second.show();
    spin(80);
    EXPECT_LT(unlikeness(before, view->grabPicture()), 0.01);
}

TEST(BodyView, ChangesTheThemeAndBack) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    const QImage dark = view->grabPicture();
    view->setDark(false);
    const QImage light = view->grabPicture();
    EXPECT_GT(light.pixelColor(470, 10).lightness(), dark.pixelColor(470, 10).lightness() + 100);
    view->setDark(true);
    EXPECT_LT(unlikeness(dark, view->grabPicture()), 1e-3);
}

TEST(BodyView, ShowsAMeshRoundTheSkin) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    const QImage without = view->grabPicture();
    auto sphere = vtkSmartPointer<vtkSphereSource>::New();
    sphere->SetRadius(0.08);
    sphere->SetCenter(0, 0, -0.05);
    sphere->Update();
    view->setMesh(sphere->GetOutput());
    EXPECT_GT(unlikeness(without, view->grabPicture()), 0.01);
    view->setMesh(nullptr);
    EXPECT_LT(unlikeness(without, view->grabPicture()), 1e-3);
}

TEST(BodyView, TakesValuesOfAnyNumber) {
    const auto view = shownView();
    view->setColourMode(ColourMode::Values);
    view->setCellValues(std::vector<float>(5, 0.5F));
    view->setBody(shared(sampleBody()));
    view->setCellValues({});
    view->setCellValues(std::vector<float>(1000, 2.0F));
    view->setCellHeights(std::vector<float>(3, 0.005F));
    EXPECT_FALSE(view->grabPicture().isNull());
    EXPECT_THROW(view->setGuideUp(Vector3d::Zero()), std::logic_error);
}

TEST(BodyView, BringsTheCamerasNextPlaceIntoViewUnlessTheUserLooksElsewhere) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    Isometry3d T_r_v = *sampleBody().views[0].T_body_camera;
    T_r_v.translation() += Vector3d(0.5, 0.3, 0);
    const auto isInView = [&] {
        const auto at = view->positionOf(T_r_v.translation());
        return at && view->rect().contains(at->toPoint());
    };
    EXPECT_FALSE(isInView());
    const Vector3d before = eyeOf(*view);
    view->setGuideCamera(T_r_v);
    EXPECT_TRUE(isInView());
    const Vector3d with = eyeOf(*view);
    view->setGuideCamera(T_r_v);
    EXPECT_EQ(eyeOf(*view), with) << "the same again moves nothing";
    view->setGuideCamera(std::nullopt);
    EXPECT_LT((eyeOf(*view) - before).norm(), 1e-6);
    press(*view, Qt::Key_Plus);
    const Vector3d users = eyeOf(*view);
    view->setGuideCamera(T_r_v);
    EXPECT_EQ(eyeOf(*view), users);
}

TEST(BodyView, ContactsStandOnTheSkinUntilTheyAreTakenAway) {
    const auto view = shownView();
    view->setBody(shared(sampleBody()));
    view->setCamerasShown(false);
    const QImage untouched = view->grabPicture();
    view->setContacts(contactsOn(*view, {3, 12}));
    EXPECT_EQ(view->contacts().size(), 2U);
    const QImage touched = view->grabPicture();
    int other = 0;
    for (int y = 0; y < touched.height(); ++y) {
        for (int x = 0; x < touched.width(); ++x)
            other += touched.pixel(x, y) != untouched.pixel(x, y) ? 1 : 0;
    }
    EXPECT_GT(other, 100);
    view->setContacts({});
    EXPECT_EQ(view->grabPicture(), untouched);
    view->setContacts(contactsOn(*view, {3}));
    view->setBody(shared(sampleBodyWithoutPictures()));
    EXPECT_TRUE(view->contacts().empty()) << "places of another body";
}

}  // namespace
}  // namespace skincal
