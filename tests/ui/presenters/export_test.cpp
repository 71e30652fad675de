// What is exported is traceable: to the data, to what decided about each detection, and to what the operator decided.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QFile>

#include "core/formats/body_json.h"
#include "core/formats/recording.h"
#include "core/session/session_storage.h"
#include "tests/ui/presenters/desk.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

using test::Desk;
using test::TemporaryDirectory;
using test::waitFor;
using testing::HasSubstr;
using testing::Not;

std::string textOf(const std::filesystem::path& file) {
    QFile bytes(QString::fromStdString(file.string()));
    EXPECT_TRUE(bytes.open(QIODevice::ReadOnly));
    return bytes.readAll().toStdString();
}

class Exported : public testing::Test {
  protected:
    Exported() : desk_(*findScenario("coded"), 1) {
        EXPECT_TRUE(desk_.connectSkin() && desk_.startCamera() && desk_.capturePoses(6));
        EXPECT_TRUE(desk_.scanHere() && desk_.moveCamera() && desk_.scanHere());
        EXPECT_TRUE(waitFor([&] { return desk_.isSolved(); }));
    }
    [[nodiscard]] std::size_t formatWith(const QString& suffix) const {
        const auto& formats = desk_.exporter.formats();
        return static_cast<std::size_t>(
            std::find_if(formats.begin(), formats.end(),
                         [&](const ExportFormat& format) { return format.suffix == suffix; }) -
            formats.begin());
    }
    std::string write(const QString& suffix) {
        desk_.exporter.write(formatWith(suffix), directory_ / "out");
        EXPECT_TRUE(waitFor([&] { return !desk_.exporter.isWriting(); }));
        return textOf(directory_ / "out");
    }

    TemporaryDirectory directory_;
    Desk desk_;
};

TEST_F(Exported, BodiesNameTheDataThatTheyFollowFrom) {
    write(".body.json");
    const auto body = readBody(directory_ / "out");
    ASSERT_TRUE(body);
    const TemporaryDirectory saved;
    ASSERT_TRUE(writeSession(desk_.session().measured(), desk_.session().decisions(), saved.path()));
    const auto recording = readRecording(saved.path());
    ASSERT_TRUE(recording);
    EXPECT_EQ(body->generator.recording_sha256, digestRecording(saved.path(), *recording).value());
    // A body that is older than the data does not follow from them.
    desk_.pose.poses().setDropped(1, true);
    write(".body.json");
    EXPECT_TRUE(readBody(directory_ / "out")->generator.recording_sha256.empty());
}

TEST_F(Exported, ReportsShowWhatDecided) {
    const ScannedView& view = desk_.session().measured().views.front();
    const ModuleId module = view.decoded.found.front().module;
    desk_.scan.showView(view.name);
    desk_.scan.detections().reject({module}, "a <lamp>");
    ASSERT_TRUE(waitFor([&] { return desk_.isSolved(); }));
    const std::string html = write(".html");
    for (const std::string& text :
         {std::string("a &lt;lamp&gt;"), desk_.workbench.skinOffers[0].name.toStdString(),
          desk_.workbench.cameraOffers[0].name.toStdString(), view.decoded.readings.front().sentBits(),
          std::string("recording.json"), std::string("<td>rejected</td>")})
        EXPECT_THAT(html, HasSubstr(text));
    std::size_t crops = 0;
    for (std::size_t at = html.find("data:image/png"); at != std::string::npos;
         at = html.find("data:image/png", at + 1))
        ++crops;
    std::size_t detections = 0;
    for (const ScannedView& one : desk_.session().measured().views) {
        detections += one.decoded.found.size();
        for (const Undetected& missing : one.decoded.undetected)
            detections += missing.nearest ? 1 : 0;
    }
    EXPECT_EQ(crops, detections);
    EXPECT_THAT(html, Not(HasSubstr("The data have changed since")));
    desk_.session().undoStack().undo();
    EXPECT_THAT(write(".html"), HasSubstr("The data have changed since"));
}

}  // namespace
}  // namespace skincal
