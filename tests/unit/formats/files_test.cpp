#include "core/formats/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/formats/image_header.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

TEST(Files, Sha256OfKnownTexts) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Files, WritingIsAllOrNothing) {
    const test::TemporaryDirectory directory;
    ASSERT_TRUE(writeFileAtomically(directory / "a.txt", "one"));
    ASSERT_TRUE(writeFileAtomically(directory / "a.txt", "two"));
    EXPECT_EQ(test::readText(directory / "a.txt"), "two");
    EXPECT_FALSE(writeFileAtomically(directory / "missing/a.txt", "x"));
    std::filesystem::create_directory(directory / "taken");
    EXPECT_FALSE(writeFileAtomically(directory / "taken", "x"));
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(directory.path())) {
        (void)entry;
        ++files;
    }
    EXPECT_EQ(files, 2U) << "no temporary file stays behind";
}

TEST(Files, WritingLeavesLinksPipesAndDevicesAsTheyAre) {
    const test::TemporaryDirectory directory;
    test::writeText(directory / "real.txt", "old");
    std::filesystem::create_symlink("real.txt", directory / "link");
    std::filesystem::create_symlink("new.txt", directory / "dangling");
    ASSERT_TRUE(writeFileAtomically(directory / "link", "new"));
    ASSERT_TRUE(writeFileAtomically(directory / "dangling", "made"));
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
    EXPECT_EQ(test::readText(directory / "real.txt"), "new");
    EXPECT_EQ(test::readText(directory / "new.txt"), "made");
    ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
    std::filesystem::create_symlink("pipe", directory / "to-pipe");
    std::filesystem::create_symlink("/dev/null", directory / "to-null");
    for (const char* name : {"pipe", "to-pipe", "to-null", "."}) {
        const auto result = writeFileAtomically(directory / name, "x");
        ASSERT_FALSE(result) << name;
        EXPECT_THAT(result.error().problem, testing::HasSubstr("expected a regular file"));
    }
    EXPECT_TRUE(std::filesystem::is_fifo(directory / "pipe"));
    EXPECT_THAT(resolveOutput(directory / "none/a").error().problem, testing::HasSubstr("there is no directory"));
    EXPECT_TRUE(sameFile(directory / "link", directory / "real.txt"));
    EXPECT_TRUE(sameFile(directory / "not-yet", directory / "x/../not-yet"));
    EXPECT_FALSE(sameFile(directory / "new.txt", directory / "real.txt"));
}

TEST(Files, ReadingRefusesWhatIsTooLargeOrNoFile) {
    const test::TemporaryDirectory directory;
    test::writeText(directory / "a.txt", "12345");
    EXPECT_EQ(readFile(directory / "a.txt", 5), "12345");
    EXPECT_FALSE(readFile(directory / "a.txt", 4));
    EXPECT_FALSE(readFile(directory.path(), 100));
    EXPECT_FALSE(readFile(directory / "none", 100));
    EXPECT_FALSE(readFile("/dev/zero", 100));
}

TEST(Files, PathsStayInside) {
    const test::TemporaryDirectory directory;
    std::filesystem::create_directory(directory / "views");
    EXPECT_TRUE(resolveInside(directory.path(), "views/a.png"));
    EXPECT_TRUE(resolveInside(directory.path(), "views/../a.png"));
    for (const char* path : {"", ".", "..", "../x", "/etc/passwd", "views/../../x"})
        EXPECT_FALSE(resolveInside(directory.path(), path)) << path;
    EXPECT_FALSE(resolveInside(directory.path(), std::string("a\0b", 3)));
}

TEST(ImageHeader, ReadsJpegAndRefusesTheRest) {
    using namespace std::string_literals;
    const std::string jpeg = "\xFF\xD8\xFF\xE0\x00\x04zz\xFF\xC0\x00\x11\x08\x01\xE0\x02\x80\x03"s;
    const auto header = parseImageHeader(jpeg);
    ASSERT_TRUE(header);
    EXPECT_EQ(header->width, 640);
    EXPECT_EQ(header->height, 480);
    for (std::size_t n = 0; n < jpeg.size() - 1; ++n)
        EXPECT_FALSE(parseImageHeader(jpeg.substr(0, n))) << n;
    EXPECT_FALSE(parseImageHeader("\xFF\xD8\xFF\xE0\x00\x01zzzz"s)) << "a segment shorter than its own length";
    EXPECT_FALSE(parseImageHeader("GIF89a"));
}

}  // namespace
}  // namespace skincal
