// The Result page: the body on pictures, and against a mesh of what it is mounted on.

#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDropEvent>
#include <QLabel>
#include <QListWidget>
#include <QMimeData>
#include <QTabWidget>
#include <QTableWidget>
#include <QTemporaryDir>
#include <QUrl>

#include "core/formats/files.h"
#include "core/formats/stl_file.h"
#include "core/simulation/body_surface.h"
#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/widgets/picture_view.h"

namespace skincal {
namespace {

/// A solved body in the window, at the Result step.
class Result : public ::testing::Test {
  protected:
    void open(const std::string& scenario) {
        world_ = buildWorld(*findScenario(scenario), 1);
        driven_.session().load(openedFrom(recordingOf(world_)));
        ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
        driven_.window.showStep(Step::Result);
    }
    /// The true body, in millimetres and a frame of its own, as a drawing of it would be.
    [[nodiscard]] QString drawing(const char* name = "body.stl") {
        const Isometry3d T_drawing_body = makeIsometry(so3Exp({0.3, -1.2, 0.8}), {0.4, 0.1, -0.6});
        const TriangleMesh mesh = scaled(transformed(bodySurface(world_), T_drawing_body), 1e3);
        return write(name, stlBytes(mesh));
    }
    [[nodiscard]] QString write(const char* name, const std::string& bytes) {
        const QString file = folder_.filePath(name);
        EXPECT_TRUE(writeFileAtomically(file.toStdString(), bytes));
        return file;
    }
    void drop(const QString& file) {
        QMimeData data;
        data.setUrls({QUrl::fromLocalFile(file)});
        QDragEnterEvent enter({40, 40}, Qt::CopyAction, &data, Qt::LeftButton, {});
        QCoreApplication::sendEvent(&driven_.window, &enter);
        QDropEvent event(QPointF(40, 40), Qt::CopyAction, &data, Qt::LeftButton, {});
        QCoreApplication::sendEvent(&driven_.window, &event);
    }
    void showTab(int index) { driven_.find<QTabWidget>("resultTabs")->setCurrentIndex(index); }
    [[nodiscard]] int rowsOf(const char* table) { return driven_.find<QTableWidget>(table)->rowCount(); }
    [[nodiscard]] QComboBox* colours() { return driven_.find<QComboBox>("colours"); }
    [[nodiscard]] bool offersDeviations() { return colours()->findData(static_cast<int>(ColourMode::Deviation)) >= 0; }
    [[nodiscard]] bool isCompared() { return rowsOf("deviations") > 0; }

    QTemporaryDir folder_;
    DrivenWindow driven_;
    World world_;
};

constexpr int kPictures = 1;
constexpr int kMesh = 2;

TEST_F(Result, AMeshDroppedOnTheWindowColoursTheBodyUntilItIsRemoved) {
    open("arm");
    BodyViewWidget& view = driven_.window.bodyView();
    EXPECT_FALSE(offersDeviations());
    driven_.window.showStep(Step::Connect);
    drop(drawing());
    EXPECT_EQ(driven_.window.step(), Step::Result) << "a mesh leads to where it is compared";
    ASSERT_TRUE(driven_.waitFor([&] { return isCompared(); }));
    EXPECT_TRUE(offersDeviations());
    EXPECT_EQ(view.colourMode(), ColourMode::Deviation);
    EXPECT_TRUE(driven_.waitFor([&] { return view.isMeshShown(); }));
    EXPECT_TRUE(view.overlay().content().legend.isDiverging);
    EXPECT_FALSE(view.overlay().content().legend.high.isEmpty());
    EXPECT_EQ(rowsOf("deviations"), static_cast<int>(world_.skin.modules.size()));
    const QString rms = driven_.find<QTableWidget>("meshFigures")->item(1, 1)->text();
    EXPECT_LT(rms.split(' ').front().toDouble(), 1.5) << rms.toStdString();

    // The farthest module is a click away.
    auto* modules = driven_.find<QTableWidget>("deviations");
    QTest::mouseClick(modules->viewport(), Qt::LeftButton, {}, modules->visualItemRect(modules->item(0, 0)).center());
    ASSERT_EQ(view.selected().size(), 1U);
    EXPECT_EQ(QString::number(view.selected().front().value), modules->item(0, 0)->text());

    ASSERT_TRUE(driven_.click("removeMesh"));
    EXPECT_FALSE(offersDeviations());
    EXPECT_FALSE(view.isMeshShown());
    EXPECT_EQ(view.colourMode(), ColourMode::Patch) << "as it was before";
    EXPECT_EQ(rowsOf("deviations"), 0);
}

TEST_F(Result, OnACylinderItSaysThatThePoseIsOpen) {
    open("cylinder");
    drop(drawing());
    ASSERT_TRUE(driven_.waitFor([&] { return isCompared(); }));
    auto* doubts = driven_.find<QListWidget>("meshDoubts");
    ASSERT_GE(doubts->count(), 2);
    EXPECT_TRUE(doubts->item(0)->text().contains("Another pose")) << doubts->item(0)->text().toStdString();
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.window.bodyView().isMeshShown(); }));
    driven_.takePicture("r-doubts");
}

TEST_F(Result, InTheWrongUnitTheMeshIsRefusedOrDoubted) {
    open("arm");
    drop(drawing());
    ASSERT_TRUE(driven_.waitFor([&] { return isCompared(); }));
    auto* unit = driven_.find<QComboBox>("meshUnit");
    unit->setCurrentIndex(unit->findData(static_cast<int>(MeshUnit::Metre)));
    const auto words = [&] { return driven_.find<QListWidget>("meshDoubts")->count(); };
    const auto complaint = [&] {
        const auto labels = driven_.window.findChildren<QLabel*>();
        return std::any_of(labels.begin(), labels.end(),
                           [](const QLabel* label) { return label->text().contains("Not compared"); });
    };
    ASSERT_TRUE(driven_.waitFor([&] { return complaint() || (isCompared() && words() > 1); }));
    unit->setCurrentIndex(unit->findData(static_cast<int>(MeshUnit::Millimetre)));
    ASSERT_TRUE(driven_.waitFor([&] { return isCompared() && words() == 1; }));
}

TEST_F(Result, ADamagedMeshIsNamedAndLeavesNothingBehind) {
    open("arm");
    drop(write("broken.stl", "solid broken\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 zero\n"));
    const auto says = [&](const QString& text) {
        const auto labels = driven_.window.findChildren<QLabel*>();
        return std::any_of(labels.begin(), labels.end(),
                           [&](const QLabel* label) { return label->text().contains(text); });
    };
    ASSERT_TRUE(driven_.waitFor([&] { return says("broken.stl: line 4"); }));
    EXPECT_FALSE(offersDeviations());
    EXPECT_FALSE(driven_.window.bodyView().isMeshShown());
    drop(drawing());
    EXPECT_TRUE(driven_.waitFor([&] { return isCompared(); })) << "the next one is none the worse";
}

TEST_F(Result, LeftInTheMiddleOfComparingItGoesOnWhereOneComesBack) {
    open("arm");
    drop(drawing());
    driven_.window.showStep(Step::Export);
    EXPECT_FALSE(isCompared());
    driven_.window.showStep(Step::Result);
    EXPECT_TRUE(driven_.waitFor([&] { return isCompared(); }));
    // A changed body is compared anew.
    driven_.session().decide("drop a pose", [](Decisions& decisions) { decisions.droppedPoses.insert(2); });
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved() && isCompared(); }));
    EXPECT_EQ(driven_.window.bodyView().colourMode(), ColourMode::Deviation);
    // And closed in the middle of it nothing is left running.
    drop(drawing("again.stl"));
    driven_.window.close();
}

TEST_F(Result, WithoutPicturesTheBodyIsDrawnOnABlankFrameThatSaysSo) {
    open("arm");
    showTab(kPictures);
    auto* picture = driven_.find<PictureView>("overlay");
    auto* views = driven_.find<QComboBox>("overlayView");
    EXPECT_EQ(views->count(), static_cast<int>(driven_.session().measured().views.size()));
    EXPECT_EQ(picture->image().size(), QSize(1280, 720));
    const auto says = [&](const QString& text) {
        const auto labels = driven_.window.findChildren<QLabel*>();
        return std::any_of(labels.begin(), labels.end(),
                           [&](const QLabel* label) { return label->isVisible() && label->text().contains(text); });
    };
    EXPECT_TRUE(says("without pictures"));
    for (int view = 0; view < views->count(); ++view) {
        views->setCurrentIndex(view);
        ASSERT_FALSE(picture->marks().empty());
        std::map<ModuleId, QPolygonF> outlines;
        for (const PictureShape& shape : picture->shapes())
            outlines[shape.module] = shape.outline;
        for (const PictureMark& mark : picture->marks()) {
            if (!mark.isCrossed) {
                EXPECT_TRUE(outlines.at(*mark.module).containsPoint(mark.pixel, Qt::OddEvenFill));
            }
        }
    }
    driven_.takePicture("r-blank");
    const std::size_t shown = picture->shapes().size();
    QTest::mouseClick(driven_.find<QCheckBox>("overlayHidden"), Qt::LeftButton, {}, QPoint(8, 8));
    EXPECT_GE(picture->shapes().size(), shown);
    // Click on the middle of one: it is shown in 3D, too.
    const PictureMark& mark = picture->marks().front();
    QTest::mouseClick(picture, Qt::LeftButton, {}, picture->toWidget(mark.pixel).toPoint());
    EXPECT_EQ(driven_.window.bodyView().selected(), std::vector{*mark.module});
}

TEST(ResultOfTheDemo, ShowsTheBodyOnItsPicturesAndAgainstTheSimulatedBody) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.capturePoses(8));
    ASSERT_TRUE(driven.useMakersIntrinsics());
    for (int view = 0; view < 3; ++view) {
        if (view > 0) {
            ASSERT_TRUE(driven.moveCameraOn());
        }
        ASSERT_TRUE(driven.scanHere());
        ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    }
    driven.window.showStep(Step::Result);
    auto* tabs = driven.find<QTabWidget>("resultTabs");
    tabs->setCurrentIndex(kPictures);
    auto* picture = driven.find<PictureView>("overlay");
    EXPECT_FALSE(picture->image().isNull());
    EXPECT_FALSE(picture->shapes().empty());
    driven.takePicture("r-pictures");
    driven.window.bodyView().setSelected({});
    tabs->setCurrentIndex(kMesh);
    driven.takePicture("r-no-mesh");
    ASSERT_TRUE(driven.click("simulatedBody"));
    auto* deviations = driven.find<QTableWidget>("deviations");
    ASSERT_TRUE(driven.waitFor([&] { return deviations->rowCount() > 0; }));
    EXPECT_EQ(driven.window.bodyView().colourMode(), ColourMode::Deviation);
    ASSERT_TRUE(driven.waitFor([&] { return driven.window.bodyView().isMeshShown(); }));
    const QString rms = driven.find<QTableWidget>("meshFigures")->item(1, 1)->text();
    EXPECT_LT(rms.split(' ').front().toDouble(), 1.5) << rms.toStdString();
    driven.takePicture("r-mesh");
    tabs->setCurrentIndex(0);
    driven.takePicture("r-quality");
}

}  // namespace
}  // namespace skincal
