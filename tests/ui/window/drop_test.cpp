// What is dragged on the window and dropped there.

#include <gtest/gtest.h>

#include <QComboBox>
#include <QDir>
#include <QDropEvent>
#include <QMimeData>
#include <QTemporaryDir>
#include <QUrl>

#include "core/formats/files.h"
#include "tests/ui/window/driven_window.h"

namespace skincal {
namespace {

const QString kRecording = QStringLiteral(SKINCAL_TEST_DATA "/recordings/flat-detections.skinrec");

class Drop : public ::testing::Test {
  protected:
    [[nodiscard]] bool isTaken(const QList<QUrl>& urls) {
        QMimeData data;
        data.setUrls(urls);
        QDragEnterEvent enter({40, 40}, Qt::CopyAction, &data, Qt::LeftButton, {});
        enter.ignore();
        QCoreApplication::sendEvent(&driven_.window, &enter);
        return enter.isAccepted();
    }
    [[nodiscard]] bool isTaken(const QString& file) { return isTaken({QUrl::fromLocalFile(file)}); }
    void drop(const QString& file) {
        QMimeData data;
        data.setUrls({QUrl::fromLocalFile(file)});
        QDropEvent event(QPointF(40, 40), Qt::CopyAction, &data, Qt::LeftButton, {});
        QCoreApplication::sendEvent(&driven_.window, &event);
    }
    [[nodiscard]] bool isOpened() {
        return driven_.waitFor([&] { return !driven_.session().measured().skin.modules.empty(); });
    }

    DrivenWindow driven_;
};

TEST_F(Drop, ARecordingIsOpened) {
    ASSERT_TRUE(isTaken(kRecording));
    drop(kRecording);
    ASSERT_TRUE(isOpened());
    const auto& views = driven_.session().measured().views;
    ASSERT_FALSE(views.empty());
    ASSERT_TRUE(driven_.waitFor([&] {
        return driven_.find<QComboBox>("views")->currentText().toStdString() == views.back().name;
    })) << "what was opened is shown, not a camera that has nothing to do with it";
}

TEST_F(Drop, SoIsOneDraggedByTheFileThatMakesItOne) {
    const QString file = QDir(kRecording).filePath("recording.json");
    ASSERT_TRUE(isTaken(file));
    drop(file);
    EXPECT_TRUE(isOpened());
}

TEST_F(Drop, OnlyWhatCanBeOpenedIsTaken) {
    const QTemporaryDir folder;
    const auto write = [&](const char* name) {
        const QString file = folder.filePath(name);
        EXPECT_TRUE(writeFileAtomically(file.toStdString(), "x"));
        return file;
    };
    EXPECT_TRUE(isTaken(write("body.STL")));
    EXPECT_FALSE(isTaken(folder.path())) << "a folder that is no recording";
    EXPECT_FALSE(isTaken(write("notes.txt")));
    EXPECT_FALSE(isTaken(folder.filePath("gone.stl")));
    EXPECT_FALSE(isTaken({QUrl("https://example.org/body.stl")}));
    EXPECT_FALSE(isTaken({QUrl::fromLocalFile(kRecording), QUrl::fromLocalFile(kRecording)})) << "one at a time";
    EXPECT_FALSE(isTaken(QList<QUrl>()));
    drop(folder.path());
    EXPECT_TRUE(driven_.session().measured().skin.modules.empty());
}

}  // namespace
}  // namespace skincal
