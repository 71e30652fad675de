// Nothing is lost: what nobody saved is there again when the program is started anew.

#include <gtest/gtest.h>

#include <QListView>
#include <QMenu>
#include <QTemporaryDir>
#include <QToolButton>

#include "core/session/session_keeper.h"
#include "tests/ui/window/driven_window.h"
#include "ui/window/file_actions.h"

namespace skincal {
namespace {

TEST(Keeper, WhatWasNotSavedIsOfferedAndGoesOnWhereItEnded) {
    const QTemporaryDir folder;
    std::vector<GravityReading> before;
    {
        DrivenWindow driven;
        SessionKeeper keeper(driven.session(), folder.path());
        EXPECT_TRUE(keeper.kept().empty());
        ASSERT_TRUE(driven.connectSkin());
        ASSERT_TRUE(driven.capturePoses(3));
        EXPECT_TRUE(keeper.kept().empty()) << "a running program's own is no remnant";
        before = driven.session().measured().gravity;
    }
    DrivenWindow driven;
    SessionKeeper keeper(driven.session(), folder.path());
    ASSERT_EQ(keeper.kept().size(), 1U);
    driven.window.offerKept(keeper);
    auto* list = driven.find<QListView>("problems");
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualRect(list->model()->index(0, 0)).center());
    ASSERT_TRUE(driven.waitFor([&] { return !driven.session().measured().skin.modules.empty(); }));
    const auto& after = driven.session().measured().gravity;
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i)
        EXPECT_EQ(after[i].acceleration, before[i].acceleration) << "though no camera was known";
    EXPECT_TRUE(driven.session().isModified()) << "it still has no file of its own";
    ASSERT_TRUE(driven.waitFor([&] { return keeper.kept().empty(); })) << "once the new program has it";
    EXPECT_TRUE(QDir(keeper.directory()).exists());
}

TEST(Keeper, OpeningAnotherRecordingKeepsWhatWasNotSavedBefore) {
    const QTemporaryDir folder;
    DrivenWindow driven;
    SessionKeeper keeper(driven.session(), folder.path());
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.capturePoses(2));
    const QString before = keeper.directory();
    ASSERT_TRUE(driven.waitFor([&] { return QDir(before).exists(QStringLiteral("recording.json")); }));
    QString opened;
    QObject::connect(&driven.session(), &Session::opened, &keeper, [&](const QString& what) { opened = what; });
    driven.window.openRecording(QStringLiteral(SKINCAL_TEST_DATA "/recordings/flat-detections.skinrec"));
    ASSERT_TRUE(driven.waitFor([&] { return !opened.isEmpty(); }));
    EXPECT_NE(keeper.directory(), before);
    ASSERT_EQ(keeper.kept().size(), 1U);
    EXPECT_EQ(keeper.kept().front().directory, before);
}

TEST(Keeper, WhatWasSavedIsNotKept) {
    const QTemporaryDir folder;
    const QTemporaryDir target;
    DrivenWindow driven;
    SessionKeeper keeper(driven.session(), folder.path());
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.capturePoses(3));
    ASSERT_TRUE(driven.useMakersIntrinsics());
    ASSERT_TRUE(driven.scanHere());
    ASSERT_TRUE(driven.waitFor([&] { return QDir(keeper.directory()).exists(QStringLiteral("recording.json")); }));
    const QString directory = target.filePath("mine.skinrec");
    driven.session().save(directory);
    ASSERT_TRUE(driven.waitFor([&] { return !driven.session().isModified(); }));
    EXPECT_TRUE(driven.waitFor([&] { return !QDir(keeper.directory()).exists(); }));
    const auto recording = readRecording(directory.toStdString());
    ASSERT_TRUE(recording) << recording.error().message();
    EXPECT_EQ(recording->views.size(), 1U);
    EXPECT_FALSE(recording->views.front().frames.empty());
}

TEST(RecentFiles, AreListedNewestFirstAndSurviveTheProgram) {
    const QTemporaryDir folder;
    const QString ini = folder.filePath("window.ini");
    const QString one = QStringLiteral(SKINCAL_TEST_DATA "/recordings/flat-detections.skinrec");
    const QString two = folder.filePath("two.skinrec");
    {
        DrivenWindow driven;
        driven.window.files().keepRecentIn(ini);
        EXPECT_TRUE(driven.window.files().recent().isEmpty());
        driven.window.openRecording(one);
        ASSERT_TRUE(driven.waitFor([&] { return driven.window.files().recent().size() == 1; }));
        driven.session().save(two);
        ASSERT_TRUE(driven.waitFor([&] { return driven.window.files().recent().size() == 2; }));
        driven.window.openRecording(folder.filePath("missing.skinrec"));
        ASSERT_TRUE(driven.waitFor([&] { return driven.window.problems().rowCount() > 0; }));
        EXPECT_EQ(driven.window.files().recent().size(), 2) << "what can't be read is none";
    }
    DrivenWindow later;
    later.window.files().keepRecentIn(ini);
    const QString first = QFileInfo(one).absoluteFilePath();
    EXPECT_EQ(later.window.files().recent(), QStringList({two, first}));
    QMenu* menu = later.find<QToolButton>("recent")->menu();
    emit menu->aboutToShow();
    ASSERT_EQ(menu->actions().size(), 2);
    menu->actions().back()->trigger();
    ASSERT_TRUE(later.waitFor([&] { return later.session().measured().skin.modules.size() > 0; }));
    EXPECT_EQ(later.window.files().recent(), QStringList({first, two})) << "the newest first";
    ASSERT_TRUE(QDir(two).removeRecursively());
    EXPECT_EQ(later.window.files().recent(), QStringList({first}));
}

}  // namespace
}  // namespace skincal
