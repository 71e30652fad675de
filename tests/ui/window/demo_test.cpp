// The whole demo in a real window, by clicks and keys, and what an operator does besides.

#include <gtest/gtest.h>

#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QRegularExpression>
#include <QTableView>
#include <QTemporaryDir>

#include "tests/ui/window/driven_window.h"
#include "tests/ui/window/true_body.h"

namespace skincal {
namespace {

TEST(Demo, LeadsFromConnectToAnExportedFile) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.connectSkin());
    driven.takePicture("1-connect");
    EXPECT_EQ(driven.session().measured().skin.modules.size(), driven.rig.world().skin.modules.size());
    EXPECT_EQ(driven.steps().states()[0].status, StepStatus::Done);

    ASSERT_TRUE(driven.capturePoses(8));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    driven.takePicture("2-pose");
    ASSERT_TRUE(driven.useMakersIntrinsics());
    ASSERT_TRUE(driven.waitFor([&] { return driven.steps().states()[2].status == StepStatus::Done; }));
    driven.takePicture("3-camera");
    ASSERT_TRUE(driven.scanHere());
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    auto* table = driven.find<QTableView>("detections");
    QTest::mouseClick(table->viewport(), Qt::LeftButton, {}, table->visualRect(table->model()->index(0, 0)).center());
    const QString evidence = driven.find<QLabel>("evidence")->text();
    EXPECT_TRUE(evidence.contains(QRegularExpression(QStringLiteral("sent [01]{24}\\nseen [01.]{24}"))))
        << evidence.toStdString();
    driven.takePicture("4-scan");

    const auto patches = [&] { return driven.session().solution()->body.patches.size(); };
    const auto isViewsDone = [&] {
        return driven.steps().states()[static_cast<std::size_t>(Step::Views)].status == StepStatus::Done;
    };
    const auto* hint = driven.find<QLabel>("hint");
    auto* progress = driven.find<QProgressBar>("scanProgress");
    for (int view = 1; view < 10 && !isViewsDone(); ++view) {
        if (view == 1) {
            ASSERT_TRUE(driven.goTo(Step::Views));
            ASSERT_TRUE(driven.waitFor([&] { return hint->text().contains("was taken from here"); }))
                << "the place of the view before is none to praise";
        }
        ASSERT_TRUE(driven.moveCameraOn());
        if (view == 1) {
            ASSERT_TRUE(driven.waitFor([&] { return hint->text().contains("In the picture"); }))
                << "what a scan would find";
            driven.takePicture("5-views");
        }
        bool isTaken = view != 1;
        const auto whileItRuns = QObject::connect(progress, &QProgressBar::valueChanged, progress, [&](int done) {
            if (!std::exchange(isTaken, isTaken || done > 70) && isTaken)
                driven.takePicture("9-scanning");
        });
        ASSERT_TRUE(driven.scanHere()) << "view " << view;
        QObject::disconnect(whileItRuns);
        ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    }
    EXPECT_EQ(driven.patchesPlaced(), patches());
    ASSERT_EQ(driven.window.step(), Step::Scan);
    ASSERT_TRUE(driven.click("next")) << "there is nothing more to move the camera for";
    EXPECT_EQ(driven.window.step(), Step::Result);
    driven.takePicture("6-result");

    ASSERT_TRUE(driven.click("next"));
    EXPECT_EQ(driven.window.step(), Step::Export);
    const QTemporaryDir folder;
    const QString file = folder.filePath("arm.body.json");
    auto* line = driven.find<QLineEdit>("file");
    ASSERT_NE(line, nullptr);
    line->clear();
    QTest::keyClicks(line, file);
    ASSERT_TRUE(driven.click("write"));
    ASSERT_TRUE(driven.waitFor([&] { return driven.steps().states()[6].status == StepStatus::Done; }));
    driven.takePicture("7-export");
    EXPECT_EQ(driven.steps().states()[6].status, StepStatus::Done);

    expectTrueBody(file, driven.rig.world());
}

}  // namespace
}  // namespace skincal
