#include "core/camera/frame_watchdog.h"

#include <gst/gst.h>
#include <gtest/gtest.h>

#include <QFile>
#include <QTemporaryDir>
#include <opencv2/core.hpp>

#include "core/camera/video_pixels.h"
#include "core/geometry/random.h"

namespace skincal {
namespace {

using Time = std::chrono::microseconds;
using std::chrono::milliseconds;

cv::Mat noise(Random& random, int width = 64, int height = 48) {
    cv::Mat image(height, width, CV_8UC1);
    for (auto& pixel : cv::Mat_<std::uint8_t>(image))
        pixel = static_cast<std::uint8_t>(random.index(256));
    return image;
}

constexpr Time kStart = std::chrono::hours(5);
constexpr Time kPeriod = milliseconds(33);

/// A source without faults, whose next frame may be tampered with.
struct Watched {
    explicit Watched(std::uint64_t seed, const FrameWatchdogOptions& options = {})
        : random(seed, "watched"), dog(options, kStart) {}

    CameraFrame next() {
        now += kPeriod;
        return {noise(random), now - milliseconds(random.index(30)) / 2, ++sequence};
    }
    /// Some good ones.
    void run(std::size_t frames) {
        for (std::size_t k = 0; k < frames; ++k) {
            last = next();
            ASSERT_EQ(dog.judge(last, now), std::nullopt);
            ASSERT_EQ(dog.check(now), std::nullopt);
        }
    }

    Random random;
    FrameWatchdog dog;
    Time now = kStart + milliseconds(100);
    std::uint64_t sequence = 0;
    CameraFrame last;
};

template <class Tamper>
void expectRefused(FrameFault fault, Tamper tamper) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Watched source(seed);
        source.run(1 + source.random.index(20));
        CameraFrame bad = source.next();
        tamper(source, bad);
        EXPECT_EQ(source.dog.judge(bad, source.now), fault) << seed;
        EXPECT_EQ(source.dog.refused(fault), 1U);
        // It does no harm to those that follow.
        source.run(5);
        EXPECT_EQ(source.dog.refused(fault), 1U);
    }
}

TEST(FrameWatchdog, PassesGoodPictures) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Watched source(seed);
        source.run(100);
        EXPECT_EQ(source.dog.accepted(), 100U);
        EXPECT_EQ(source.dog.refused(), (std::array<std::uint64_t, kFrameFaults>{}));
    }
}

TEST(FrameWatchdog, RefusesAPictureOfTheSameNumber) {
    expectRefused(FrameFault::RepeatedSequence, [](Watched& source, CameraFrame& bad) {
        bad.sequence = source.last.sequence - source.random.index(source.last.sequence);
    });
}

TEST(FrameWatchdog, RefusesAPictureOfTheSameTimeOrBefore) {
    expectRefused(FrameFault::RepeatedTime, [](Watched& source, CameraFrame& bad) {
        bad.time = source.last.time - milliseconds(source.random.index(20));
    });
}

TEST(FrameWatchdog, RefusesAPictureOfLongAgo) {
    expectRefused(FrameFault::Stale, [](Watched& source, CameraFrame& bad) {
        source.now += std::chrono::seconds(2);
        bad.time = std::max(source.last.time + Time(1), source.now - std::chrono::seconds(1) - Time(1));
    });
}

TEST(FrameWatchdog, RefusesAPictureFromBeforeTheStart) {
    Watched source(1);
    CameraFrame early = source.next();
    early.time = kStart - Time(1);
    EXPECT_EQ(source.dog.judge(early, source.now), FrameFault::Stale);
}

TEST(FrameWatchdog, RefusesAPictureThatIsYetToBeTaken) {
    expectRefused(FrameFault::FromTheFuture, [](Watched& source, CameraFrame& bad) {
        bad.time = source.now + milliseconds(51 + source.random.index(10000));
    });
}

TEST(FrameWatchdog, RefusesTheSamePictureAgain) {
    expectRefused(FrameFault::RepeatedContent, [](Watched& source, CameraFrame& bad) {
        bad.image = source.random.uniform() < 0.5 ? source.last.image : source.last.image.clone();
    });
}

TEST(FrameWatchdog, PassesBlackPicturesHoweverAlike) {
    Watched source(1);
    for (int i = 0; i < 30; ++i) {
        CameraFrame dark = source.next();
        dark.image.setTo(16);
        EXPECT_EQ(source.dog.judge(dark, source.now), std::nullopt) << i;
        source.last = dark;
    }
}

TEST(FrameWatchdog, PassesAPictureThatDiffersInOnePixel) {
    Watched source(1);
    source.run(1);
    CameraFrame other = source.next();
    other.image = source.last.image.clone();
    other.image.at<std::uint8_t>(47, 63) ^= 1;
    EXPECT_EQ(source.dog.judge(other, source.now), std::nullopt);
}

TEST(FrameWatchdog, PassesAStillVideoWhereToldTo) {
    FrameWatchdogOptions options;
    options.mayStandStill = true;
    Watched source(1, options);
    source.run(1);
    CameraFrame same = source.next();
    same.image = source.last.image;
    EXPECT_EQ(source.dog.judge(same, source.now), std::nullopt);
}

TEST(FrameWatchdog, RefusesPicturesOfAnotherSize) {
    expectRefused(FrameFault::WrongSize, [](Watched& source, CameraFrame& bad) {
        bad.image = noise(source.random, 64 + static_cast<int>(source.random.index(2)), 47);
    });
    FrameWatchdogOptions options;
    options.width = 65;
    options.height = 48;
    Watched source(1, options);
    EXPECT_EQ(source.dog.judge(source.next(), source.now), FrameFault::WrongSize);
}

TEST(FrameWatchdog, RefusesNothing) {
    expectRefused(FrameFault::Empty, [](Watched&, CameraFrame& bad) { bad.image = cv::Mat(); });
}

/// What videotestsrc really draws.
cv::Mat testPicture(const char* format, int width, int height) {
    gst_init(nullptr, nullptr);
    const QTemporaryDir folder;
    const QString file = folder.filePath("picture");
    const std::string launch = "videotestsrc num-buffers=1 ! video/x-raw,format=" + std::string(format) +
                               ",width=" + std::to_string(width) + ",height=" + std::to_string(height) +
                               " ! filesink location=" + file.toStdString();
    GstElement* pipeline = gst_parse_launch(launch.c_str(), nullptr);
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    GstBus* bus = gst_element_get_bus(pipeline);
    gst_message_unref(gst_bus_timed_pop_filtered(bus, 20 * GST_SECOND, GST_MESSAGE_EOS));
    gst_object_unref(bus);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
    QFile raw(file);
    EXPECT_TRUE(raw.open(QIODevice::ReadOnly));
    const QByteArray bytes = raw.readAll();
    const bool isLuma = std::string(format) == "I420";
    return pictureOf(isLuma ? PixelLayout::Luma : PixelLayout::Bgra,
                     {reinterpret_cast<const std::uint8_t*>(bytes.constData()), static_cast<std::size_t>(bytes.size())},
                     width, height, isLuma ? (width + 3) / 4 * 4 : 4 * width);
}

TEST(FrameWatchdog, RefusesTheTestPictureThatStandsForNoCamera) {
    for (const char* format : {"I420", "BGRx"}) {
        for (const auto& [width, height] : {std::pair(320, 240), {640, 480}, {642, 360}, {1280, 720}, {1920, 1080}}) {
            const cv::Mat picture = testPicture(format, width, height);
            ASSERT_FALSE(picture.empty());
            EXPECT_TRUE(isTestPicture(picture)) << format << width;
            FrameWatchdog dog({}, kStart);
            EXPECT_EQ(dog.judge({picture, kStart, 1}, kStart), FrameFault::TestPicture);
        }
    }
}

TEST(TestPicture, IsNothingThatALensSees) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        Random random(seed, "not a test picture");
        EXPECT_FALSE(isTestPicture(noise(random, 320, 240)));
        EXPECT_FALSE(isTestPicture(cv::Mat(240, 320, CV_8UC1, cv::Scalar(random.uniform(0, 255)))));
        // One noisy pixel will do.
        cv::Mat picture = testPicture("I420", 320, 240);
        picture.at<std::uint8_t>(0, 10 + static_cast<int>(random.index(20))) ^= 1;
        EXPECT_FALSE(isTestPicture(picture));
    }
    EXPECT_FALSE(isTestPicture(cv::Mat()));
    EXPECT_FALSE(isTestPicture(cv::Mat(4, 4, CV_8UC1, cv::Scalar(0))));
    EXPECT_FALSE(isTestPicture(cv::Mat(240, 320, CV_16UC1, cv::Scalar(0))));
}

/// Checks every 100 ms, as a source does, and gives what tampers make of its pictures.
std::optional<CameraTrouble> troubleAfter(std::size_t good, const std::function<void(Watched&, CameraFrame&)>& tamper,
                                          FrameWatchdogOptions options = {}, Time* noticed = nullptr) {
    Watched source(7, options);
    source.run(good);
    const Time since = source.now;
    while (source.now < since + std::chrono::seconds(10)) {
        CameraFrame frame = source.next();
        if (tamper) {
            tamper(source, frame);
            static_cast<void>(source.dog.judge(frame, source.now));
        }
        if (const auto trouble = source.dog.check(source.now)) {
            if (noticed != nullptr)
                *noticed = source.now - since;
            return trouble;
        }
    }
    return std::nullopt;
}

TEST(FrameWatchdog, NoticesWithinASecondThatNothingComes) {
    Time noticed{};
    EXPECT_EQ(troubleAfter(10, nullptr, {}, &noticed), CameraTrouble::Silent);
    EXPECT_LT(noticed, std::chrono::seconds(1));
}

TEST(FrameWatchdog, HasMorePatienceWithTheFirst) {
    Time noticed{};
    EXPECT_EQ(troubleAfter(0, nullptr, {}, &noticed), CameraTrouble::NoFirstPicture);
    EXPECT_GT(noticed, std::chrono::seconds(4));
}

TEST(FrameWatchdog, NamesWhatIsWrongWithThePicturesThatCome) {
    using Tamper = std::function<void(Watched&, CameraFrame&)>;
    const std::vector<std::pair<CameraTrouble, Tamper>> cases = {
        {CameraTrouble::Unreadable, [](Watched&, CameraFrame& frame) { frame.image = cv::Mat(); }},
        {CameraTrouble::WrongSize,
         [](Watched& source, CameraFrame& frame) { frame.image = noise(source.random, 9, 9); }},
        {CameraTrouble::Frozen, [](Watched& source, CameraFrame& frame) { frame.image = source.last.image; }},
        {CameraTrouble::Unsteady, [](Watched&, CameraFrame& frame) { frame.sequence = 1; }},
        {CameraTrouble::Unsteady, [](Watched& source, CameraFrame& frame) { frame.time = source.last.time; }},
        {CameraTrouble::Late, [](Watched& source, CameraFrame& frame) {
             source.now += std::chrono::seconds(2);
             frame.time = source.now - std::chrono::seconds(1) - Time(1);
         }}};
    for (const auto& [trouble, tamper] : cases)
        EXPECT_EQ(troubleAfter(5, tamper), trouble);
    EXPECT_EQ(troubleAfter(0, [](Watched&, CameraFrame& frame) { frame.image = testPicture("I420", 320, 240); }),
              CameraTrouble::TestPicture);
}

TEST(FrameWatchdog, DoesNotBlameTheSourceForItsCallersSleep) {
    Watched source(1);
    source.run(5);
    source.now += std::chrono::minutes(1);
    EXPECT_EQ(source.dog.check(source.now), std::nullopt);
    source.run(5);
}

TEST(FrameWatchdog, ThrowsForOptionsOutOfRange) {
    FrameWatchdogOptions options;
    options.width = 640;
    EXPECT_FALSE(options.validate());
    EXPECT_THROW(FrameWatchdog(options, kStart), std::logic_error);
    options = {};
    options.nextPicture = Time(0);
    EXPECT_THROW(FrameWatchdog(options, kStart), std::logic_error);
}

}  // namespace
}  // namespace skincal
