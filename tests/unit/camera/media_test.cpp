#include <gst/gst.h>
#include <gtest/gtest.h>

#include <QFile>
#include <QSignalSpy>
#include <QTemporaryDir>

#include "core/camera/media_source.h"
#include "tests/wait_for.h"

namespace skincal {
namespace {

using test::waitFor;

/// A video of a ball that moves; false where GStreamer can't make one.
bool makeVideo(const QString& file, int frames) {
    gst_init(nullptr, nullptr);
    const std::string launch = "videotestsrc pattern=ball num-buffers=" + std::to_string(frames) +
                               " ! video/x-raw,format=I420,width=320,height=240,framerate=25/1 ! jpegenc ! avimux ! "
                               "filesink location=\"" +
                               file.toStdString() + "\"";
    GstElement* pipeline = gst_parse_launch(launch.c_str(), nullptr);
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    GstBus* bus = gst_element_get_bus(pipeline);
    GstMessage* message = gst_bus_timed_pop_filtered(bus, 60 * GST_SECOND,
                                                     static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
    const bool isMade = message != nullptr && GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS;
    if (message != nullptr)
        gst_message_unref(message);
    gst_object_unref(bus);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
    return isMade;
}

struct Media : testing::Test {
    void open(const QString& typed) {
        const auto url = videoUrl(typed);
        ASSERT_TRUE(url);
        media = std::make_unique<MediaSource>(*url);
        QObject::connect(media.get(), &FrameSource::frameArrived, media.get(),
                         [this](const CameraFrame& frame) { frames.push_back(frame); });
        QObject::connect(media.get(), &FrameSource::failed, media.get(), [this](const QString& why) {
            reason = why;
            heard.emplace_back("failed");
        });
        QObject::connect(media.get(), &FrameSource::stopped, media.get(), [this] { heard.emplace_back("stopped"); });
        media->start();
    }
    [[nodiscard]] bool hearsTheEnd() {
        return waitFor([&] { return heard.size() >= 2; }) && heard == std::vector<std::string>{"failed", "stopped"};
    }

    QTemporaryDir folder;
    std::unique_ptr<MediaSource> media;
    std::vector<CameraFrame> frames;
    std::vector<std::string> heard;
    QString reason;
};

TEST_F(Media, PlaysAFileToItsEndAndAgain) {
    const QString file = folder.filePath("a ball.avi");
    ASSERT_TRUE(makeVideo(file, 50));
    open(file);
    EXPECT_EQ(media->name(), "a ball.avi");
    EXPECT_TRUE(media->formats().empty());
    for (int round = 0; round < 2; ++round) {
        frames.clear();
        ASSERT_TRUE(hearsTheEnd());
        EXPECT_EQ(media->failure()->trouble, CameraTrouble::Ended) << reason.toStdString();
        EXPECT_GT(frames.size(), 25U);
        for (std::size_t k = 1; k < frames.size(); ++k) {
            EXPECT_GT(frames[k].time, frames[k - 1].time);
            EXPECT_GT(frames[k].sequence, frames[k - 1].sequence);
        }
        EXPECT_EQ(frames.front().image.cols, 320);
        EXPECT_EQ(media->format().height, 240);
        EXPECT_NEAR(media->format().framesPerSecond, 25, 1);
        heard.clear();
        media->start();
    }
    EXPECT_THROW(media->setFormat({1, 1, 1}), std::logic_error);
}

TEST_F(Media, IsStoppedWithoutAWord) {
    const QString file = folder.filePath("ball.avi");
    ASSERT_TRUE(makeVideo(file, 500));
    open("file://" + file);
    ASSERT_TRUE(waitFor([&] { return frames.size() > 5 || !heard.empty(); }));
    media->stop();
    ASSERT_TRUE(waitFor([&] { return !heard.empty(); }));
    EXPECT_EQ(heard, std::vector<std::string>{"stopped"});
    EXPECT_FALSE(media->exposureRange());
    EXPECT_TRUE(media->controls().empty());
}

TEST_F(Media, SaysThatThereIsNoSuchFile) {
    open(folder.filePath("none.avi"));
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_EQ(media->failure()->trouble, CameraTrouble::Missing);
    open(folder.path());
    heard.clear();
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_EQ(media->failure()->trouble, CameraTrouble::Missing);
}

TEST_F(Media, SaysThatAFileIsNoVideo) {
    QFile file(folder.filePath("noise.avi"));
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(QByteArray(10000, 'x'));
    file.close();
    open(file.fileName());
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_EQ(media->failure()->trouble, CameraTrouble::CannotPlay);
}

TEST_F(Media, SaysThatAStreamCannotBeReached) {
    // Nobody listens there.
    open("http://127.0.0.1:9/stream");
    ASSERT_TRUE(hearsTheEnd());
    EXPECT_EQ(media->failure()->trouble, CameraTrouble::CannotPlay) << reason.toStdString();
}

TEST(VideoUrl, IsAPathOrAnAddress) {
    EXPECT_EQ(videoUrl("/tmp/a b.avi")->toLocalFile(), "/tmp/a b.avi");
    EXPECT_TRUE(videoUrl("b:c.avi")->isLocalFile());
    EXPECT_EQ(videoUrl(" rtsp://u:p@host/x ")->scheme(), "rtsp");
    EXPECT_EQ(MediaSource(*videoUrl("rtsp://u:p@host/x")).name(), "rtsp://host/x");
    EXPECT_FALSE(videoUrl(""));
    EXPECT_FALSE(videoUrl("  "));
    EXPECT_FALSE(videoUrl("udp://host:1"));
    EXPECT_FALSE(videoUrl("gst-pipeline://x"));
    EXPECT_FALSE(videoUrl("http://a b"));
}

}  // namespace
}  // namespace skincal
