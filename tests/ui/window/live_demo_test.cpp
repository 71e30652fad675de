// The live demo in a real window: the mouse touches a simulated skin whose clock stands still until it is told to go
// on.

#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QSlider>
#include <QTableWidget>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/scene3d/scene_widget.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

constexpr double kPitch = 27.785e-3;

class LiveDemo : public ::testing::Test {
  protected:
    void SetUp() override {
        // The rig's own world as if it had been calibrated before, which takes a moment rather than a minute.
        Scenario scanned = driven.rig.world().scenario;
        scanned.views.scan = ScanKind::Detections;
        const World world = buildWorld(scanned, driven.rig.world().seed);
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
            ASSERT_TRUE(world.T_r_u[u].isApprox(driven.rig.world().T_r_u[u]));
        driven.session().load(openedFrom(recordingOf(world)));
        ASSERT_TRUE(driven.connectSkin());
        ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
        driven.window.showStep(Step::Demo);
        pass(50ms);
        ASSERT_FALSE(facing().empty());
    }

    [[nodiscard]] BodyViewWidget& view() { return driven.window.bodyView(); }
    [[nodiscard]] QTableWidget& contacts() { return *driven.find<QTableWidget>("contacts"); }
    [[nodiscard]] QString contact(int column) { return contacts().item(0, column)->text(); }

    /// Three columns.
    [[nodiscard]] Vector3d contactVector(int first) {
        return {contact(first).toDouble(), contact(first + 1).toDouble(), contact(first + 2).toDouble()};
    }

    /// Lets that much of the rig's time pass, and no more.
    void pass(RigClock::Time time) {
        RigClock& clock = driven.rig.clock();
        bool isOver = false;
        clock.at(clock.now() + time, &driven.window, [&] {
            clock.hold();
            isOver = true;
        });
        if (isHeld_)
            clock.release();
        isHeld_ = true;
        ASSERT_TRUE(driven.waitFor([&] { return isOver; }));
    }

    /// Until the page shows it.
    [[nodiscard]] bool isShown(const QString& module) {
        return driven.waitFor([&] { return contact(0) == module; });
    }

    [[nodiscard]] QPoint pixelOf(const ShownModule& module) {
        return view().positionOf(module.T_s_u.translation())->toPoint();
    }

    /// Modules that can be touched where the camera stands.
    [[nodiscard]] std::vector<const ShownModule*> facing() {
        std::vector<const ShownModule*> modules;
        for (const ShownModule& module : view().layoutShown().modules) {
            if (module.placed && view().moduleAt(pixelOf(module)) == module.id)
                modules.push_back(&module);
        }
        return modules;
    }

    void press(const QPoint& at) { QTest::mousePress(&view().scene(), Qt::LeftButton, {}, at); }
    void release(const QPoint& at) { QTest::mouseRelease(&view().scene(), Qt::LeftButton, {}, at); }
    void drag(const QPoint& to) {
        QMouseEvent move(QEvent::MouseMove, to, view().scene().mapToGlobal(to), Qt::NoButton, Qt::LeftButton, {});
        QCoreApplication::sendEvent(&view().scene(), &move);
    }

    /// The rig's body frame in that of the body model, by way of a module.
    [[nodiscard]] Isometry3d T_b_r(const ShownModule& by) {
        const World& world = driven.rig.world();
        return by.T_s_u * world.T_r_u[world.skin.indexById().at(by.id)].inverse();
    }

    DrivenWindow driven;

  private:
    bool isHeld_ = false;
};

QString textOf(ModuleId module) {
    return QString::number(module.value);
}

TEST_F(LiveDemo, FeelsTheMouseWhereItIsAndForgetsItAfterwards) {
    const auto modules = facing();
    ASSERT_GE(modules.size(), 6U);
    const ShownModule& reference = *modules.back();
    press(pixelOf(*modules.front()));
    for (std::size_t i = 0; i + 1 < modules.size(); i += 4) {
        const ShownModule& module = *modules[i];
        const QPoint pixel = pixelOf(module);
        drag(pixel);
        pass(100ms);
        ASSERT_TRUE(isShown(textOf(module.id)));
        EXPECT_GT(contact(1).toDouble(), 1);
        const Isometry3d T = T_b_r(reference);
        const Vector3d truth_b = T * driven.rig.contact()->point_r;
        EXPECT_LT((1e-3 * contactVector(2) - truth_b).norm(), kPitch) << module.id.value;
        const World& world = driven.rig.world();
        const Vector3d normal_b = T.linear() * world.T_r_u[world.skin.indexById().at(module.id)].linear().col(2);
        EXPECT_GT(contactVector(5).dot(normal_b), std::cos(5 * kDegree)) << module.id.value;
        EXPECT_EQ(pixelOf(module), pixel) << "the camera moved";
    }
    driven.takePicture("8-demo-drag");
    // Off the body nothing is touched, though the button is still down.
    drag(QPoint(3, view().height() - 3));
    EXPECT_FALSE(driven.rig.contact().has_value());
    drag(pixelOf(*modules.front()));
    EXPECT_TRUE(driven.rig.contact().has_value());
    release(pixelOf(*modules.front()));
    EXPECT_FALSE(driven.rig.contact().has_value());
    pass(100ms);
    EXPECT_TRUE(isShown(QString()));
}

TEST_F(LiveDemo, TurnsTheBodyWhereThePressBeginsBesideItOrTouchIsOff) {
    const ShownModule& module = *facing().front();
    const auto dragFrom = [&](const QPoint& from) {
        const QPoint before = pixelOf(module);
        press(from);
        for (const int x : {10, 30, 60})
            drag(from + QPoint(x, -x));
        EXPECT_FALSE(driven.rig.contact().has_value());
        release(from + QPoint(60, -60));
        return pixelOf(module) - before;
    };
    EXPECT_GT(dragFrom(QPoint(3, view().height() - 3)).manhattanLength(), 5);
    ASSERT_TRUE(driven.click("touch"));
    EXPECT_GT(dragFrom(pixelOf(module)).manhattanLength(), 5);
    // A click chooses what is traced.
    const QPoint pixel = pixelOf(*facing().back());
    const ModuleId chosen = facing().back()->id;
    QTest::mouseClick(&view().scene(), Qt::LeftButton, {}, pixel);
    EXPECT_EQ(view().selected(), std::vector{chosen});
    EXPECT_FALSE(driven.find<QCheckBox>("follow")->isChecked());
}

TEST_F(LiveDemo, ShowsThePastAndComesBack) {
    const ShownModule& module = *facing().front();
    const QPoint pixel = pixelOf(module);
    pass(1s);
    press(pixel);
    pass(1s);
    ASSERT_TRUE(isShown(textOf(module.id)));
    release(pixel);
    pass(2s);
    ASSERT_TRUE(isShown(QString()));
    auto* time = driven.find<QSlider>("time");
    time->setValue(-250);  // hundredths of a second
    EXPECT_TRUE(isShown(textOf(module.id)));
    driven.takePicture("8-demo-past");
    // What is looked at stays, however much time passes.
    pass(40s);
    time->setValue(-350);
    EXPECT_TRUE(isShown(QString()));
    time->setValue(-250);
    EXPECT_TRUE(isShown(textOf(module.id)));
    // It goes back no further than the past does.
    time->setValue(time->minimum());
    EXPECT_GT(time->value(), -410);
    ASSERT_TRUE(driven.click("live"));
    EXPECT_EQ(time->value(), 0);
    pass(50ms);
    EXPECT_TRUE(isShown(QString()));
    // Whoever touches sees it at once.
    time->setValue(-100);
    press(pixel);
    pass(100ms);
    EXPECT_TRUE(isShown(textOf(module.id)));
    EXPECT_EQ(time->value(), 0);
    release(pixel);
}

TEST_F(LiveDemo, StreamsAndColoursOnlyWhileItIsShown) {
    int samples = 0;
    QObject::connect(driven.workbench.skin(), &SkinDevice::tactileArrived, &driven.window, [&] { ++samples; });
    pass(200ms);
    EXPECT_NEAR(samples, 20, 2);
    EXPECT_EQ(view().colourMode(), ColourMode::Values);
    press(pixelOf(*facing().front()));
    EXPECT_TRUE(driven.rig.contact().has_value());
    driven.window.showStep(Step::Result);
    EXPECT_FALSE(driven.rig.contact().has_value());
    // The rest of that press is no click on another page.
    release(pixelOf(*facing().front()));
    EXPECT_EQ(view().colourMode(), ColourMode::Patch);
    EXPECT_TRUE(view().selected().empty());
    samples = 0;
    pass(1s);
    EXPECT_EQ(samples, 0);
    driven.window.showStep(Step::Demo);
    pass(200ms);
    EXPECT_NEAR(samples, 20, 2);
}

TEST_F(LiveDemo, GoesRoundTheBodyWhileAsked) {
    const ShownModule& module = *facing().front();
    const QPoint before = pixelOf(module);
    ASSERT_TRUE(driven.click("orbit"));
    EXPECT_TRUE(driven.waitFor([&] { return (pixelOf(module) - before).manhattanLength() > 5; }));
    ASSERT_TRUE(driven.click("orbit"));
    const QPoint after = pixelOf(module);
    pass(200ms);
    EXPECT_EQ(pixelOf(module), after);
}

TEST_F(LiveDemo, FillsTheScreenAndComesBack) {
    QWidget* home = view().parentWidget();
    const QSize size = view().size();
    ASSERT_TRUE(driven.click("fullScreen"));
    EXPECT_TRUE(view().isWindow());
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&view()));
    EXPECT_GT(view().width(), size.width());
    driven.takeBodyPicture("8-demo-full");
    press(pixelOf(*facing().front()));
    pass(100ms);
    EXPECT_TRUE(isShown(textOf(facing().front()->id)));
    release(pixelOf(*facing().front()));
    QTest::keyClick(&view(), Qt::Key_Escape);
    EXPECT_FALSE(view().isWindow());
    EXPECT_EQ(view().parentWidget(), home);
    ASSERT_TRUE(driven.waitFor([&] { return view().size() == size; }));
    EXPECT_FALSE(view().grabPicture().isNull());
    // Leaving the page leaves the full screen, too.
    ASSERT_TRUE(driven.click("fullScreen"));
    driven.window.showStep(Step::Result);
    EXPECT_FALSE(view().isWindow());
}

TEST_F(LiveDemo, SaysWhatItsColoursMean) {
    const auto modules = facing();
    for (const std::size_t i : {0U, 3U, 7U}) {
        const ShownModule& module = *modules.at(i % modules.size());
        press(pixelOf(module));
        pass(1500ms);
        ASSERT_TRUE(isShown(textOf(module.id)));
        release(pixelOf(module));
        pass(800ms);
    }
    const ShownModule& module = *modules[modules.size() / 2];
    press(pixelOf(module));
    pass(600ms);
    ASSERT_TRUE(isShown(textOf(module.id)));
    auto* quantity = driven.find<QComboBox>("quantity");
    for (int i = 0; i < quantity->count(); ++i) {
        quantity->setCurrentIndex(i);
        pass(50ms);
        EXPECT_EQ(view().overlay().content().legend.title, quantity->currentText());
        EXPECT_FALSE(view().overlay().content().legend.high.isEmpty());
        driven.takePicture(QStringLiteral("8-demo-") + quantity->currentText().toLower());
    }
    release(pixelOf(module));
}

}  // namespace
}  // namespace skincal
