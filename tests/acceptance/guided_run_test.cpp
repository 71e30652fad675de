// The whole product on real interfaces: a virtual skin behind a pseudo-terminal, a virtual webcam through GStreamer and
// Qt Multimedia, and the program that calibrates one with the other, without a window.

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QFile>
#include <QProcess>
#include <iostream>

#include "core/formats/body_json.h"
#include "tests/fixtures/desk_with_wires.h"
#include "tests/wait_for.h"

namespace skincal {
namespace {

using test::waitFor;

constexpr auto kCameraName = test::DeskWithWires::kCameraName;

/// The program at such a desk, and somebody who does what files in a folder ask for.
class DeskWithWires : public test::DeskWithWires {
  public:
    explicit DeskWithWires(const char* scenario, const WireFaults& faults = {}, std::uint64_t seed = 5)
        : test::DeskWithWires(scenario, faults, seed) {
        obey_.setInterval(10);
        QObject::connect(&obey_, &QTimer::timeout, &obey_, [this] {
            if (const auto pose = asked("pose", pose_))
                turn(*pose);
            if (const auto view = asked("view", view_))
                moveCamera(*view);
        });
        obey_.start();
    }

    /// Runs the program until it ends; its exit code.
    /// @param meanwhile  what somebody at the desk does, called again and again
    int run(
        const QStringList& arguments, const std::function<void()>& meanwhile = [] {}) {
        output.clear();
        QProcess program;
        program.setProcessChannelMode(QProcess::MergedChannels);
        program.start(QStringLiteral(SKINCAL_PROGRAM), arguments);
        const bool ended = waitFor([&] {
            output += program.readAll().toStdString();
            meanwhile();
            return program.state() == QProcess::NotRunning;
        });
        output += program.readAll().toStdString();
        if (!ended)
            program.kill();
        program.waitForFinished();
        return ended && program.exitStatus() == QProcess::NormalExit ? program.exitCode() : -1;
    }

    [[nodiscard]] bool said(const char* text) const { return output.find(text) != std::string::npos; }
    [[nodiscard]] int timesSaid(const char* text) const {
        int times = 0;
        for (std::size_t at = output.find(text); at != std::string::npos; at = output.find(text, at + 1))
            ++times;
        return times;
    }

    std::string output;

  private:
    /// A number in a file, where somebody has written a new one.
    [[nodiscard]] std::optional<int> asked(const char* name, int& last) const {
        QFile text(file(name));
        if (!text.open(QIODevice::ReadOnly))
            return std::nullopt;
        bool fine = false;
        const int number = text.readAll().trimmed().toInt(&fine);
        if (!fine || number == last)
            return std::nullopt;
        last = number;
        return number;
    }

    QTimer obey_;
    int pose_ = -1;
    int view_ = -1;
};

TEST(GuidedRun, CalibratesASkinThroughASerialPortAndAWebcam) {
    DeskWithWires desk("demo");
    const int code = desk.run({"run", "--device", desk.port(), "--camera", kCameraName, "--intrinsics", desk.lensFile(),
                               "-o", desk.file("desk.skinrec"), "--poses", "6", "--views", "6", "--on-pose",
                               QStringLiteral("echo $SKINCAL_POSE > %1").arg(desk.file("pose")), "--on-view",
                               QStringLiteral("echo $SKINCAL_VIEW > %1; sleep 2").arg(desk.file("view"))});
    EXPECT_EQ(code, 0) << desk.output;
    const auto body = readBody(desk.file("desk.body.json").toStdString());
    ASSERT_TRUE(body) << desk.output;
    const auto recorded = readRecording(desk.file("desk.skinrec").toStdString());
    ASSERT_TRUE(recorded);
    const BodyComparison difference = desk.differenceFromTruth(*body, recorded->skin);
    EXPECT_EQ(difference.compared, desk.rig().world().T_r_u.size());
    // As exact as where the same world is recorded without any wire.
    const double reference = desk.errorWithoutWires();
    std::cout << "position " << 1e3 * difference.positionRms << " mm rms, without wires " << 1e3 * reference << " mm\n";
    EXPECT_LT(difference.positionRms, 1.25 * reference) << desk.output;
}

TEST(GuidedRun, OnABadWireItIsTheSame) {
    WireFaults faults;
    faults.byteErrors = 1e-3;
    DeskWithWires desk("demo", faults);
    const int code = desk.run({"run", "--device", desk.port(), "--views", "0", "--intrinsics", desk.lensFile(), "-o",
                               desk.file("desk.skinrec"), "--poses", "5", "--on-pose",
                               QStringLiteral("echo $SKINCAL_POSE > %1").arg(desk.file("pose"))});
    EXPECT_NE(code, 2) << desk.output;
    EXPECT_NE(code, -1) << desk.output;
    const auto recording = readRecording(desk.file("desk.skinrec").toStdString());
    ASSERT_TRUE(recording) << desk.output;
    EXPECT_EQ(recording->skin.modules.size(), desk.rig().world().T_r_u.size());
    EXPECT_EQ(recording->skin.links.size(), desk.rig().world().skin.links.size());
    EXPECT_EQ(recording->gravity.size(), 5 * desk.rig().world().T_r_u.size());
}

TEST(GuidedRun, GoesOnWithWhatWasBrokenOff) {
    DeskWithWires desk("demo");
    const QString onPose = QStringLiteral("echo $SKINCAL_POSE > %1").arg(desk.file("pose"));
    const QString onView = QStringLiteral("echo $SKINCAL_VIEW > %1; sleep 2").arg(desk.file("view"));
    const auto arguments = [&](const char* views, const QString& pose, const QString& view) {
        return QStringList{"run",           "--device",  desk.port(),
                           "--camera",      kCameraName, "--intrinsics",
                           desk.lensFile(), "-o",        desk.file("desk.skinrec"),
                           "--poses",       "4",         "--views",
                           views,           "--on-pose", pose,
                           "--on-view",     view};
    };
    // Killed at its third pose, then before its second view, once what was measured before is written.
    const auto killedWhen = [&](const char* word, const char* file) {
        return QStringLiteral("until grep -q '%1' %2/%3; do sleep 0.1; done; kill -9 $PPID")
            .arg(QLatin1String(word), desk.file("desk.skinrec"), QLatin1String(file));
    };
    EXPECT_EQ(desk.run(arguments("2",
                                 QStringLiteral("if [ $SKINCAL_POSE = 2 ]; then %1; else %2; fi")
                                     .arg(killedWhen("^1,", "gravity.csv"), onPose),
                                 onView)),
              -1);
    EXPECT_NE(desk.run(arguments("2", onPose, onView)), 0) << "somebody's recording is not to be lost";
    EXPECT_NE(desk.output.find("--resume"), std::string::npos) << desk.output;
    EXPECT_EQ(desk.run(arguments("2", onPose, killedWhen("view0", "recording.json")) << "--resume"), -1) << desk.output;
    EXPECT_NE(desk.output.find("2 poses and 0 views"), std::string::npos) << desk.output;
    const auto begun = readRecording(desk.file("desk.skinrec").toStdString());
    ASSERT_TRUE(begun) << desk.output;
    ASSERT_EQ(begun->views.size(), 1U);

    // No pose is taken again: nobody would turn the body.
    const int code = desk.run(arguments("2", "exit 1", onView) << "--resume");
    EXPECT_TRUE(code == 0 || code == 1) << desk.output;
    const auto whole = readRecording(desk.file("desk.skinrec").toStdString());
    ASSERT_TRUE(whole) << desk.output;
    EXPECT_EQ(whole->gravity.size(), 4 * desk.rig().world().T_r_u.size());
    ASSERT_EQ(whole->views.size(), 2U);
    for (std::size_t i = 0; i < begun->gravity.size(); ++i)
        EXPECT_EQ(whole->gravity[i].acceleration, begun->gravity[i].acceleration);
    EXPECT_EQ(whole->views.front().frames.front().file, begun->views.front().frames.front().file);

    // With another skin it is left alone.
    DeskWithWires other("arm", {}, 6);
    QStringList strange = arguments("3", onPose, onView) << "--resume";
    strange[2] = other.port();
    EXPECT_EQ(desk.run(strange), 2);
    EXPECT_NE(desk.output.find("another skin"), std::string::npos) << desk.output;
    EXPECT_EQ(readRecording(desk.file("desk.skinrec").toStdString())->views.size(), 2U);
}

TEST(GuidedRun, NamesWhoDoesNotAnswerAnyMore) {
    DeskWithWires desk("demo");
    const auto goOn = [&](const QString& dead) {
        return desk.run({"run", "--device",
                         QStringLiteral("exec:" SKINCAL_PROGRAM " virtual-skin plane --stdio ") + dead, "--intrinsics",
                         desk.lensFile(), "-o", desk.file("plane.skinrec"), "--poses", "1", "--views", "0", "--on-pose",
                         "true", "--resume"});
    };
    EXPECT_NE(goOn({}), 2) << desk.output;
    EXPECT_FALSE(desk.said("do not answer")) << desk.output;
    // One in the patch that a cable leads to, farthest from it.
    const World world = buildWorld(*findScenario("plane"), 1);
    const auto last = std::count(world.patchOf.begin(), world.patchOf.end(), world.patchOf.front()) - 1;
    const auto dead = world.skin.modules[static_cast<std::size_t>(last)].id.value;
    EXPECT_NE(goOn(QStringLiteral("--dead %1").arg(dead)), 2) << desk.output;
    EXPECT_TRUE(desk.said("1 of the recording's modules do not answer: ")) << desk.output;
    EXPECT_TRUE(desk.said("1 poses and 0 views are there already")) << desk.output;
}

TEST(GuidedRun, SaysWhatIsMissing) {
    DeskWithWires desk("demo");
    const QStringList common{"run", "-o", desk.file("desk.skinrec"), "--intrinsics", desk.lensFile()};
    EXPECT_EQ(desk.run(common + QStringList{"--device", "/dev/ttyNOSUCH", "--camera", kCameraName}), 2);
    EXPECT_NE(desk.output.find("plugged in"), std::string::npos) << desk.output;
    EXPECT_EQ(desk.run(common + QStringList{"--device", desk.port(), "--camera", "Nobody's webcam"}), 2);
    EXPECT_NE(desk.output.find(kCameraName), std::string::npos) << desk.output;
    EXPECT_FALSE(desk.said("XDG_RUNTIME_DIR")) << desk.output;
    EXPECT_FALSE(desk.said("PulseAudio")) << desk.output;
    EXPECT_EQ(desk.run(common + QStringList{"--device", "tcp://nowhere", "--camera", kCameraName}), 2);
    EXPECT_NE(desk.output.find("tcp://host:port"), std::string::npos) << desk.output;
}

TEST(GuidedRun, AStreamThatNobodySendsIsToldBeforeAnyPose) {
    DeskWithWires desk("demo");
    EXPECT_EQ(desk.run({"run", "-o", desk.file("desk.skinrec"), "--intrinsics", desk.lensFile(), "--device",
                        desk.port(), "--camera", "http://127.0.0.1:9/stream"}),
              2)
        << desk.output;
    EXPECT_TRUE(desk.said("http://127.0.0.1:9/stream")) << desk.output;
    EXPECT_FALSE(desk.said("Pose 1")) << desk.output;
}

/// One pose and one view of a small skin, the shortest run in which all takes part.
QStringList shortRun(const DeskWithWires& desk) {
    return {"run",
            "--device",
            desk.port(),
            "--camera",
            kCameraName,
            "--intrinsics",
            desk.lensFile(),
            "-o",
            desk.file("desk.skinrec"),
            "--poses",
            "1",
            "--views",
            "1"};
}

/// Such a run came to its end, with its view, and not by trying again what had failed.
void expectItsView(const DeskWithWires& desk, int code) {
    EXPECT_TRUE(code == 0 || code == 1) << desk.output;
    EXPECT_FALSE(desk.said("The scan failed")) << desk.output;
    const auto recording = readRecording(desk.file("desk.skinrec").toStdString());
    ASSERT_TRUE(recording) << desk.output;
    EXPECT_EQ(recording->views.size(), 1U) << desk.output;
}

TEST(GuidedRun, ASkinThatIsUnpluggedInAScanIsWaitedForAndTheViewScannedAnew) {
    DeskWithWires desk("demo");
    int unplugs = 0;
    bool isOut = false;
    // As often as a scan that fails is tried.
    const int code = desk.run(shortRun(desk), [&] {
        if (!isOut && unplugs < 3 && desk.timesSaid("View 1 of 1: scanning") > unplugs && desk.shines()) {
            desk.unplugSkin();
            isOut = true;
            ++unplugs;
        } else if (isOut && desk.timesSaid("Waiting until it is there again") == unplugs) {
            desk.plugSkin();
            isOut = false;
        }
    });
    EXPECT_EQ(unplugs, 3) << desk.output;
    EXPECT_EQ(desk.timesSaid("View 1 of 1: scanning"), 4) << desk.output;
    EXPECT_EQ(desk.timesSaid("was unplugged"), 3) << desk.output;
    EXPECT_EQ(desk.timesSaid("The skin is there again"), 3) << desk.output;
    expectItsView(desk, code);
    // This camera has no controls that anybody could hold.
    EXPECT_EQ(desk.timesSaid("may change its exposure"), 1) << desk.output;
    EXPECT_EQ(desk.timesSaid("Not held: exposure"), 1) << desk.output;
}

TEST(GuidedRun, ALensForPicturesOfAnotherSizeIsToldAsSoonAsOneCame) {
    DeskWithWires desk("demo");
    CameraModel lens = desk.rig().world().scenario.camera;
    lens.width *= 2;
    ASSERT_TRUE(writeCameraModel(desk.lensFile().toStdString(), lens));
    EXPECT_EQ(desk.run(shortRun(desk)), 2) << desk.output;
    EXPECT_TRUE(desk.said("The intrinsics are for")) << desk.output;
    EXPECT_FALSE(desk.said("Pose 1")) << "the body was turned for nothing";
    EXPECT_FALSE(desk.said("gave no pictures")) << desk.output;
}

TEST(GuidedRun, ASkinThatNeverComesBackEndsItAndIsNamed) {
    DeskWithWires desk("demo");
    const int code = desk.run(shortRun(desk) << "--patience"
                                             << "2",
                              [&] {
                                  if (desk.said("View 1 of 1: scanning") && desk.shines())
                                      desk.unplugSkin();
                              });
    EXPECT_EQ(code, 2) << desk.output;
    EXPECT_TRUE(desk.said("the skin did not come back within 2 s. The")) << desk.output;
    EXPECT_EQ(desk.timesSaid("Waiting until it is there again"), 1) << desk.output;
    EXPECT_TRUE(desk.said("--resume")) << desk.output;
}

TEST(GuidedRun, ASkinThatIsLostBetweenPosesIsWaitedForLikewise) {
    DeskWithWires desk("demo");
    const QString onPose = QStringLiteral("echo $SKINCAL_POSE > %1").arg(desk.file("pose"));
    const QStringList arguments{
        "run", "--device", desk.port(), "--intrinsics", desk.lensFile(), "-o", desk.file("desk.skinrec"), "--poses",
        "2",   "--views",  "0",         "--on-pose",    onPose};
    bool isBack = false;
    int code = desk.run(arguments, [&] {
        if (!isBack && desk.said("Waiting until it is there again")) {
            desk.plugSkin();
            isBack = true;
        } else if (!isBack && desk.said("Pose 2 of 2")) {
            desk.unplugSkin();
        }
    });
    EXPECT_TRUE(code == 0 || code == 1) << desk.output;
    EXPECT_EQ(desk.timesSaid("Waiting until it is there again"), 1) << desk.output;
    auto recording = readRecording(desk.file("desk.skinrec").toStdString());
    ASSERT_TRUE(recording) << desk.output;
    EXPECT_EQ(recording->gravity.size(), 2 * desk.rig().world().T_r_u.size());

    code = desk.run(QStringList(arguments) << "--force"
                                           << "--patience"
                                           << "2",
                    [&] {
                        if (desk.said("Pose 2 of 2"))
                            desk.unplugSkin();
                    });
    EXPECT_EQ(code, 2) << desk.output;
    EXPECT_TRUE(desk.said("the skin did not come back within 2 s")) << desk.output;
}

TEST(GuidedRun, ACameraThatIsUnpluggedInAScanIsWaitedForAndTheViewScannedAnew) {
    DeskWithWires desk("demo");
    bool isOut = false;
    bool isBack = false;
    const int code = desk.run(shortRun(desk), [&] {
        if (!isOut && desk.said("View 1 of 1: scanning") && desk.shines()) {
            desk.camera().unplug();
            isOut = true;
        } else if (isOut && !isBack && desk.said("Waiting until it is there again")) {
            desk.camera().plug();
            isBack = true;
        }
    });
    EXPECT_EQ(desk.timesSaid("View 1 of 1: scanning"), 2) << desk.output;
    EXPECT_EQ(desk.timesSaid("The camera was unplugged"), 1) << desk.output;
    EXPECT_EQ(desk.timesSaid("The camera gives pictures again"), 1) << desk.output;
    expectItsView(desk, code);
}

TEST(GuidedRun, ACameraThatNeverComesBackEndsItAndIsNamed) {
    DeskWithWires desk("demo");
    const int code = desk.run(shortRun(desk) << "--patience"
                                             << "2",
                              [&] {
                                  if (desk.said("View 1 of 1: scanning") && desk.shines())
                                      desk.camera().unplug();
                              });
    EXPECT_EQ(code, 2) << desk.output;
    EXPECT_TRUE(desk.said("the camera did not come back within 2 s. The camera")) << desk.output;
    EXPECT_EQ(desk.timesSaid("Waiting until it is there again"), 1) << desk.output;
}

}  // namespace
}  // namespace skincal

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    const auto cameras = skincal::test::prepareVirtualCameras();
    const QCoreApplication application(argc, argv);
    return RUN_ALL_TESTS();
}
