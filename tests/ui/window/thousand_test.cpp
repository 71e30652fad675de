// A skin of 1,000 modules in the window: however much there is, the driven window allows no event to take long.

#include <gtest/gtest.h>

#include <QTemporaryDir>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/scene3d/body_view_widget.h"

namespace skincal {
namespace {

TEST(Thousand, ModulesOfARecordingAreShownOnEveryPage) {
    const QTemporaryDir folder;
    const QString file = folder.filePath("thousand.skinrec");
    const auto written = writeRecording(recordingOf(buildWorld(*findScenario("thousand"), 1)), file.toStdString());
    ASSERT_TRUE(written) << written.error().message();
    DrivenWindow driven;
    driven.window.openRecording(file);
    ASSERT_TRUE(driven.waitFor([&] { return driven.session().measured().skin.modules.size() == 1000; }));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    for (const Step step : kSteps) {
        driven.window.showStep(step);
        for (int turn = 0; turn < 20; ++turn)
            QCoreApplication::processEvents();
    }
    EXPECT_EQ(driven.window.bodyView().layoutShown().modules.size(), 1000U);
}

}  // namespace
}  // namespace skincal
