#include <gtest/gtest.h>

#include <QCameraDevice>
#include <QMediaDevices>
#include <QSignalSpy>
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <opencv2/core.hpp>

#include "core/camera/webcam_source.h"
#include "core/geometry/random.h"
#include "core/simulation/renderer.h"
#include "core/simulation/world.h"
#include "tests/fixtures/virtual_camera/virtual_camera.h"
#include "tests/unit/camera/fake_v4l2.h"
#include "tests/wait_for.h"

namespace skincal {
namespace {

using test::VirtualCamera;
using test::waitFor;

/// Each test has its own: Qt may still list that of the test before.
std::string uniqueName() {
    static int count = 0;
    return "Virtual camera " + std::to_string(++count);
}

VirtualCamera::Painter noise(const VirtualCamera::Kind& kind) {
    return [kind](std::uint64_t k) {
        return test::bytesOf(kind.format, kind.width, kind.height, test::noisyLuma(kind.width, kind.height, k));
    };
}

/// What was given away as picture k, for every picture that came: by content, for any may be left out.
void expectPicturesOf(const std::vector<CameraFrame>& frames, const std::function<cv::Mat(std::uint64_t)>& picture,
                      std::uint64_t given) {
    std::uint64_t k = 0;
    for (const CameraFrame& frame : frames) {
        const auto isSame = [&](const cv::Mat& other) {
            cv::Mat grey;
            if (frame.image.channels() == 3)
                cv::extractChannel(frame.image, grey, 1);
            else
                grey = frame.image;
            return grey.size() == other.size() && cv::norm(grey, other, cv::NORM_INF) == 0;
        };
        while (k < given && !isSame(picture(k)))
            ++k;
        ASSERT_LT(k, given) << "a picture came that nobody took";
        ++k;
    }
}

class Webcam : public testing::Test {
  protected:
    explicit Webcam(VirtualCamera::Kind kind = {}) : kind_(kind), device_(name_, kind, noise(kind)) {}

    [[nodiscard]] const ListedCamera* listed() const { return listed(name_); }
    [[nodiscard]] const ListedCamera* listed(const std::string& name) const {
        for (const ListedCamera& camera : list_->cameras()) {
            if (camera.description == name)
                return &camera;
        }
        return nullptr;
    }

    [[nodiscard]] bool plugAndMake(WebcamOptions options = {}) {
        device_.plug();
        if (!waitFor([&] { return listed() != nullptr; }))
            return false;
        camera_ = std::make_unique<WebcamSource>(list_, *listed(), options);
        listen();
        return true;
    }

    void listen() {
        QObject::connect(camera_.get(), &FrameSource::frameArrived, camera_.get(), [this](const CameraFrame& frame) {
            frames_.push_back(frame);
            arrivals_.push_back(camera_->now());
        });
        QObject::connect(camera_.get(), &FrameSource::failed, camera_.get(), [this](const QString& why) {
            why_ = why;
            heard_.emplace_back("failed");
        });
        QObject::connect(camera_.get(), &FrameSource::stopped, camera_.get(),
                         [this] { heard_.emplace_back("stopped"); });
    }

    [[nodiscard]] bool runFor(std::size_t frames) {
        const std::size_t before = frames_.size();
        return waitFor([&] { return frames_.size() >= before + frames || !heard_.empty(); }) && heard_.empty();
    }
    [[nodiscard]] bool hearsTheEnd() {
        return waitFor([&] { return heard_.size() >= 2; }) && heard_ == std::vector<std::string>{"failed", "stopped"};
    }

    const std::string name_ = uniqueName();
    VirtualCamera::Kind kind_;
    VirtualCamera device_;
    std::shared_ptr<CameraList> list_ = std::make_shared<CameraList>();
    std::unique_ptr<WebcamSource> camera_;
    std::vector<CameraFrame> frames_;
    std::vector<std::chrono::microseconds> arrivals_;
    QString why_;
    std::vector<std::string> heard_;
};

TEST_F(Webcam, IsListedOpenedAndStreams) {
    ASSERT_TRUE(plugAndMake());
    EXPECT_EQ(camera_->name().toStdString(), name_);
    EXPECT_EQ(camera_->formats(), (std::vector<FrameFormat>{{640, 480, 30}, {320, 240, 30}}));
    camera_->start();
    ASSERT_TRUE(runFor(60)) << why_.toStdString();
    camera_->stop();
    ASSERT_TRUE(waitFor([&] { return !heard_.empty(); }));
    EXPECT_EQ(heard_, std::vector<std::string>{"stopped"});
    for (std::size_t k = 1; k < frames_.size(); ++k) {
        EXPECT_GT(frames_[k].time, frames_[k - 1].time);
        EXPECT_GT(frames_[k].sequence, frames_[k - 1].sequence);
    }
}

struct Pixels : Webcam, testing::WithParamInterface<const char*> {
    Pixels() : Webcam({GetParam(), 322, 242, 30}) {}
};

TEST_P(Pixels, AreThoseOfTheCamera) {
    ASSERT_TRUE(plugAndMake());
    camera_->start();
    ASSERT_TRUE(runFor(15)) << why_.toStdString();
    camera_->stop();
    expectPicturesOf(
        frames_,
        [&](std::uint64_t k) {
            auto luma = test::noisyLuma(kind_.width, kind_.height, k);
            return cv::Mat(kind_.height, kind_.width, CV_8UC1, luma.data()).clone();
        },
        device_.times().size());
    EXPECT_EQ(frames_.front().image.channels(), kind_.format == "bgrx" ? 3 : 1);
}

INSTANTIATE_TEST_SUITE_P(Formats, Pixels, testing::Values("i420", "nv12", "yuy2", "uyvy", "gray8", "bgrx"));

TEST_F(Webcam, WhoseDeviceIsGoneIsNotStarted) {
    ASSERT_TRUE(plugAndMake());
    device_.unplug();
    ASSERT_TRUE(waitFor([&] { return listed() == nullptr; }));
    camera_->start();
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_TRUE(frames_.empty());
    EXPECT_EQ(camera_->failure()->trouble, CameraTrouble::NotPluggedIn);
}

// In full with SKINCAL_UNPLUGS=1000.
TEST_F(Webcam, UnpluggedIsNoticedWithinASecondAndResumesOncePluggedInAgain) {
    ASSERT_TRUE(plugAndMake());
    const char* text = std::getenv("SKINCAL_UNPLUGS");
    const int unplugs = text ? std::atoi(text) : 50;
    Random chance(1, "unplugs");
    std::chrono::microseconds slowestNotice{};
    std::chrono::microseconds slowestReturn{};
    std::optional<std::uint64_t> last;
    auto plugged = camera_->now();
    for (int round = 0; round <= unplugs; ++round) {
        camera_->start();
        ASSERT_TRUE(runFor(1)) << round << why_.toStdString();
        slowestReturn = std::max(slowestReturn, camera_->now() - plugged);
        ASSERT_TRUE(runFor(static_cast<std::size_t>(12 * chance.uniform()))) << round << why_.toStdString();
        for (const CameraFrame& frame : frames_) {
            EXPECT_TRUE(!last || frame.sequence > *last) << round;
            last = frame.sequence;
        }
        frames_.clear();
        if (round == unplugs)
            break;
        const auto pulled = camera_->now();
        device_.unplug();
        ASSERT_TRUE(hearsTheEnd()) << round;
        slowestNotice = std::max(slowestNotice, camera_->now() - pulled);
        EXPECT_EQ(camera_->failure()->trouble, CameraTrouble::Unplugged);
        EXPECT_FALSE(camera_->isRunning());
        heard_.clear();
        const QSignalSpy returned(camera_.get(), &FrameSource::returned);
        plugged = camera_->now();
        device_.plug();
        ASSERT_TRUE(waitFor([&] { return !returned.empty(); })) << round;
    }
    EXPECT_LT(slowestNotice, std::chrono::seconds(1));
    EXPECT_LT(slowestReturn, std::chrono::seconds(5));
    std::cout << unplugs << " unplugs: noticed within " << 1e-6 * static_cast<double>(slowestNotice.count())
              << " s, a picture within " << 1e-6 * static_cast<double>(slowestReturn.count()) << " s of being back\n";
}

TEST_F(Webcam, ThatGivesNoMorePicturesFails) {
    ASSERT_TRUE(plugAndMake());
    camera_->start();
    ASSERT_TRUE(runFor(10));
    device_.hang();
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_EQ(camera_->failure()->trouble, CameraTrouble::Silent);
    heard_.clear();
    device_.hang(false);
    camera_->start();
    EXPECT_TRUE(runFor(10));
}

TEST_F(Webcam, ThatNeverGivesAPictureFails) {
    WebcamOptions options;
    options.watchdog.firstPicture = std::chrono::milliseconds(500);
    device_.hang();
    ASSERT_TRUE(plugAndMake(options));
    camera_->start();
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_EQ(camera_->failure()->trouble, CameraTrouble::NoFirstPicture);
}

TEST_F(Webcam, ThatIsFrozenFails) {
    ASSERT_TRUE(plugAndMake());
    camera_->start();
    ASSERT_TRUE(runFor(10));
    device_.setPainter([paint = noise(kind_)](std::uint64_t) { return paint(0); });
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_EQ(camera_->failure()->trouble, CameraTrouble::Frozen);
    EXPECT_GT(camera_->refused()[static_cast<std::size_t>(FrameFault::RepeatedContent)], 5U);
}

TEST_F(Webcam, ThatShowsATestPictureFails) {
    WebcamOptions options;
    options.watchdog.firstPicture = std::chrono::milliseconds(800);
    device_.setPainter([this](std::uint64_t) {
        std::vector<std::uint8_t> luma;
        for (int pixel = 0; pixel < kind_.width * kind_.height; ++pixel)
            luma.push_back(static_cast<std::uint8_t>(180 - 24 * (pixel % kind_.width * 7 / kind_.width)));
        return test::bytesOf(kind_.format, kind_.width, kind_.height, luma);
    });
    ASSERT_TRUE(plugAndMake(options));
    camera_->start();
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_TRUE(frames_.empty());
    EXPECT_EQ(camera_->failure()->trouble, CameraTrouble::TestPicture);
}

TEST_F(Webcam, ShowsWhatTheWorldLooksLike) {
    const World world = buildWorld(*findScenario("coded"), 3);
    const FrameRenderer renderer(world, 0, 100);
    const CameraModel& lens = world.scenario.camera;
    const std::vector<LitModule> lit = {{world.skin.modules.front().id}};
    std::vector<cv::Mat> drawn;
    for (std::size_t k = 0; k < 20; ++k)
        drawn.push_back(renderer.render(k % 2 == 0 ? lit : std::vector<LitModule>(), k));
    const auto picture = [&](std::uint64_t k) { return drawn[k % drawn.size()]; };
    const std::string name = uniqueName();
    VirtualCamera device(name, {"i420", lens.width, lens.height, 30}, [&](std::uint64_t k) {
        const cv::Mat luma = picture(k);
        return test::bytesOf("i420", luma.cols, luma.rows, {luma.begin<std::uint8_t>(), luma.end<std::uint8_t>()});
    });
    device.plug();
    const ListedCamera* camera = nullptr;
    ASSERT_TRUE(waitFor([&] { return (camera = listed(name)) != nullptr; }));
    camera_ = std::make_unique<WebcamSource>(list_, *camera);
    listen();
    camera_->start();
    ASSERT_TRUE(runFor(30)) << why_.toStdString();
    camera_->stop();
    expectPicturesOf(frames_, picture, device.times().size());
}

TEST_F(Webcam, DatesNoPictureLaterThanItWasTaken) {
    ASSERT_TRUE(plugAndMake());
    camera_->start();
    ASSERT_TRUE(runFor(60)) << why_.toStdString();
    camera_->stop();
    const auto given = device_.times();
    // By then the shortest delay is known.
    std::uint64_t k = 0;
    std::vector<std::chrono::microseconds> delays;
    for (const CameraFrame& frame : frames_) {
        while (k < given.size() && frame.image.at<std::uint8_t>(0) != test::noisyLuma(1, 1, k)[0])
            ++k;
        ASSERT_LT(k, given.size());
        delays.push_back(arrivals_[static_cast<std::size_t>(&frame - frames_.data())] - given[k]);
        if (&frame - frames_.data() < 30)
            continue;
        EXPECT_LE(frame.time, given[k]);
    }
    std::sort(delays.begin(), delays.end());
    RecordProperty("median_delay_us", static_cast<int>(delays[delays.size() / 2].count()));
    RecordProperty("longest_delay_us", static_cast<int>(delays.back().count()));
}

TEST_F(Webcam, ChangesItsFormatWhileItRuns) {
    ASSERT_TRUE(plugAndMake());
    EXPECT_THROW(camera_->setFormat({1, 1, 30}), std::logic_error);
    camera_->start();
    ASSERT_TRUE(runFor(5));
    EXPECT_EQ(frames_.back().image.size(), cv::Size(640, 480));
    const std::uint64_t sequence = frames_.back().sequence;
    camera_->setFormat({320, 240, 30});
    EXPECT_EQ(camera_->format(), (FrameFormat{320, 240, 30}));
    frames_.clear();
    ASSERT_TRUE(waitFor([&] { return frames_.size() >= 5; })) << why_.toStdString();
    for (const CameraFrame& frame : frames_) {
        EXPECT_EQ(frame.image.size(), cv::Size(320, 240));
        EXPECT_GT(frame.sequence, sequence);
    }
}

TEST_F(Webcam, MayBeDestroyedByWhoHearsOfIt) {
    ASSERT_TRUE(plugAndMake());
    bool isGone = false;
    QObject::connect(camera_.get(), &FrameSource::frameArrived, qApp, [&] {
        camera_.reset();
        isGone = true;
    });
    camera_->start();
    ASSERT_TRUE(waitFor([&] { return isGone; }));
    camera_ = std::make_unique<WebcamSource>(list_, *listed());
    listen();
    camera_->start();
    ASSERT_TRUE(runFor(5));
    isGone = false;
    QObject::connect(camera_.get(), &FrameSource::failed, qApp, [&] {
        camera_.reset();
        isGone = true;
    });
    device_.unplug();
    ASSERT_TRUE(waitFor([&] { return isGone; }));
}

/// Of a camera that is no Video4Linux device nobody says that its exposure stands still.
TEST_F(Webcam, SaysThatItsControlsCannotBeReached) {
    WebcamOptions options;
    options.settle = std::chrono::milliseconds(1);
    ASSERT_TRUE(plugAndMake(options));
    camera_->start();
    const QSignalSpy changed(camera_.get(), &FrameSource::abilitiesChanged);
    ASSERT_TRUE(waitFor([&] { return !changed.empty() || !heard_.empty(); }));
    ASSERT_EQ(camera_->controls().size(), kCameraControls.size());
    for (const ControlState& state : camera_->controls())
        EXPECT_EQ(state.outcome, ControlState::Outcome::NoAccess);
    EXPECT_FALSE(camera_->exposureRange());
    camera_->stop();
    EXPECT_TRUE(camera_->controls().empty());
}

/// Qt 6.4 crashes where a camera is made for such a device: hence it is looked up first.
TEST_F(Webcam, OfADeviceThatQtForgotIsNull) {
    device_.plug();
    ASSERT_TRUE(waitFor([&] { return listed() != nullptr; }));
    const ListedCamera camera = *listed();
    EXPECT_FALSE(CameraList::deviceOf(camera).isNull());
    device_.unplug();
    ASSERT_TRUE(waitFor([&] { return listed() == nullptr; }));
    EXPECT_TRUE(CameraList::deviceOf(camera).isNull());
}

/// A webcam whose node exists, too: Qt's part is virtual, the node's is made up.
struct WithNode : Webcam {
    WithNode() { list_ = std::make_shared<CameraList>(system_); }
    ~WithNode() override { camera_.reset(); }

    test::FakeV4l2 system_{{{"/dev/video7", test::FakeNode::webcam(name_)}}};
    test::FakeNode& node() { return *system_.nodes.at("/dev/video7"); }
};

TEST_F(WithNode, LocksItsControlsAndPutsThemBack) {
    WebcamOptions options;
    options.settle = std::chrono::milliseconds(1);
    const auto before = node().values();
    ASSERT_TRUE(plugAndMake(options));
    EXPECT_EQ(camera_->camera().node, "/dev/video7");
    for (int round = 0; round < 2; ++round) {
        camera_->start();
        const QSignalSpy changed(camera_.get(), &FrameSource::abilitiesChanged);
        ASSERT_TRUE(waitFor([&] { return !changed.empty() || !heard_.empty(); }));
        for (const ControlState& state : camera_->controls())
            EXPECT_EQ(state.outcome, ControlState::Outcome::Locked);
        ASSERT_TRUE(camera_->exposureRange());
        if (round == 0)
            camera_->setExposure(0.004);
        // Kept from the run before.
        EXPECT_NEAR(camera_->exposure().value(), 0.004, 1e-9);
        EXPECT_NE(node().values(), before);
        if (round == 0) {
            camera_->stop();
            heard_.clear();
        } else {
            device_.unplug();
            ASSERT_TRUE(hearsTheEnd());
        }
        EXPECT_EQ(node().values(), before);
        EXPECT_EQ(node().open, 0);
        QCoreApplication::processEvents();
        heard_.clear();
    }
}

TEST_F(WithNode, SaysWhyItGivesNoPictures) {
    WebcamOptions options;
    options.watchdog.firstPicture = std::chrono::milliseconds(300);
    device_.hang();
    ASSERT_TRUE(plugAndMake(options));
    for (const auto& [error, trouble] : {std::pair(EBUSY, CameraTrouble::Busy),
                                         {EACCES, CameraTrouble::Forbidden},
                                         {0, CameraTrouble::NoFirstPicture}}) {
        camera_->start();
        node().formatError = error == EBUSY ? EBUSY : 0;
        node().openError = error == EACCES ? EACCES : 0;
        ASSERT_TRUE(hearsTheEnd());
        EXPECT_EQ(camera_->failure()->trouble, trouble);
        EXPECT_EQ(camera_->failure()->where, "/dev/video7");
        heard_.clear();
        node().openError = 0;
    }
}

struct ListedTwice : Webcam {
    ListedTwice() : Webcam({"i420", 640, 480, 30, 2}) {}
};

TEST_F(ListedTwice, IsOfferedOnce) {
    device_.plug();
    const auto times = [&] {
        const auto all = QMediaDevices::videoInputs();
        return std::count_if(all.begin(), all.end(),
                             [&](const auto& device) { return device.description().toStdString() == name_; });
    };
    ASSERT_TRUE(waitFor([&] { return times() == 2; }));
    list_->refresh();
    const auto& cameras = list_->cameras();
    EXPECT_EQ(std::count_if(cameras.begin(), cameras.end(),
                            [&](const ListedCamera& camera) { return camera.description == name_; }),
              1);
}

TEST_F(ListedTwice, IsUnpluggedAndPluggedInLikeAnyOther) {
    ASSERT_TRUE(plugAndMake());
    for (int round = 0; round < 3; ++round) {
        camera_->start();
        ASSERT_TRUE(runFor(5)) << why_.toStdString();
        device_.unplug();
        ASSERT_TRUE(hearsTheEnd());
        EXPECT_EQ(camera_->failure()->trouble, CameraTrouble::Unplugged);
        ASSERT_TRUE(waitFor([&] { return listed() == nullptr; }));
        heard_.clear();
        device_.plug();
        ASSERT_TRUE(waitFor([&] { return listed() != nullptr; }));
    }
}

TEST(Multimedia, KeepsPipeWiresCamerasOutAndWhatElseIsRankedIn) {
    const QByteArray before = qgetenv("GST_PLUGIN_FEATURE_RANK");
    qunsetenv("GST_PLUGIN_FEATURE_RANK");
    prepareMultimedia();
    EXPECT_EQ(qgetenv("GST_PLUGIN_FEATURE_RANK"), "pipewiredeviceprovider:NONE");
    qputenv("GST_PLUGIN_FEATURE_RANK", "vah264dec:MAX");
    prepareMultimedia();
    prepareMultimedia();
    EXPECT_EQ(qgetenv("GST_PLUGIN_FEATURE_RANK"), "vah264dec:MAX,pipewiredeviceprovider:NONE");
    qputenv("GST_PLUGIN_FEATURE_RANK", before);
}

}  // namespace
}  // namespace skincal
