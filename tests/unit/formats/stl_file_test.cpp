#include "core/formats/stl_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/geometry/random.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

using test::TemporaryDirectory;
using test::writeText;
using testing::AllOf;
using testing::HasSubstr;

const std::string kTriangle =
    "solid a part with a name\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1.5e0 0 0\n"
    "   vertex 0 +2 0\n  endloop\n endfacet\nendsolid a part with a name\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what), what.size(), by);
}

std::string complaintOf(const std::string& bytes) {
    const auto mesh = parseStl(bytes, "arm.stl");
    return mesh ? "none" : mesh.error().message();
}

TEST(StlFile, WhatIsWrittenIsReadBack) {
    Random random(1, "stl");
    const TemporaryDirectory directory;
    for (int i = 0; i < 20; ++i) {
        const TriangleMesh tube = tubeMesh(random.normal3(), random.normal3(), random.uniform(0.1, 1), 12);
        writeText(directory / "tube.stl", stlBytes(tube));
        const auto mesh = readStl(directory / "tube.stl");
        ASSERT_TRUE(mesh) << mesh.error().message();
        EXPECT_EQ(mesh->vertices.size(), tube.vertices.size());
        EXPECT_EQ(mesh->triangles.size(), tube.triangles.size());
        EXPECT_NEAR(enclosedVolume(*mesh).value() / enclosedVolume(tube).value(), 1, 1e-4);
    }
}

TEST(StlFile, ReadsTextOfAnyCaseAndAllOfItsSolids) {
    const auto mesh = parseStl(kTriangle + replaced(kTriangle, "1.5e0", "7") + "\n\n", "arm.stl");
    ASSERT_TRUE(mesh) << mesh.error().message();
    EXPECT_EQ(mesh->triangles.size(), 2U);
    EXPECT_NEAR(mesh->area(), 1.5 + 7, 1e-12);
    EXPECT_TRUE(parseStl(replaced(replaced(kTriangle, "facet", "FACET"), "vertex", "Vertex"), "arm.stl"));
    EXPECT_TRUE(parseStl(replaced(kTriangle, "\n", "\r\n"), "arm.stl"));
}

TEST(StlFile, ABinaryOneMayBeginWithSolid) {
    std::string bytes = stlBytes(tubeMesh(Vector3d::Zero(), Vector3d::UnitX(), 1, 5));
    std::memcpy(bytes.data(), "solid", 5);
    EXPECT_TRUE(parseStl(bytes, "arm.stl"));
}

TEST(StlFile, WhatIsInsideOutIsTurned) {
    TriangleMesh tube = tubeMesh(Vector3d::Zero(), Vector3d::UnitX(), 1, 20);
    for (auto& corners : tube.triangles)
        std::swap(corners[0], corners[1]);
    EXPECT_GT(enclosedVolume(parseStl(stlBytes(tube), "arm.stl").value()).value(), 0);
}

TEST(StlFile, RefusalsNameTheFileThePlaceAndWhatWasExpected) {
    EXPECT_THAT(complaintOf(""), AllOf(HasSubstr("arm.stl"), HasSubstr("empty")));
    EXPECT_THAT(complaintOf("ply\n"), AllOf(HasSubstr("arm.stl"), HasSubstr("expected an STL mesh")));
    EXPECT_THAT(complaintOf("solid nothing\nendsolid\n"), HasSubstr("none of which has an area"));
    EXPECT_THAT(complaintOf(replaced(kTriangle, "1.5e0", "1.5x")), AllOf(HasSubstr("line 5"), HasSubstr("1.5x")));
    EXPECT_THAT(complaintOf(replaced(kTriangle, "1.5e0", "nan")), HasSubstr("line 5"));
    EXPECT_THAT(complaintOf(replaced(kTriangle, "1.5e0", "1e300")), HasSubstr("up to 1e9"));
    EXPECT_THAT(complaintOf(replaced(kTriangle, "   vertex 0 +2 0\n", "")), HasSubstr("three times 'vertex'"));
    EXPECT_THAT(complaintOf(replaced(kTriangle, "endloop", "vertex 1 1 1 endloop")), HasSubstr("'endloop'"));
    EXPECT_THAT(complaintOf(replaced(kTriangle, "facet normal", "polygon normal")), HasSubstr("'facet'"));
    EXPECT_THAT(complaintOf(kTriangle.substr(0, 60)), HasSubstr("the file ends"));
    EXPECT_THAT(complaintOf(replaced(kTriangle, "0 +2 0", "3 0 0")), HasSubstr("none of which has an area"));

    const std::string whole = stlBytes(tubeMesh(Vector3d::Zero(), Vector3d::UnitX(), 1, 8));
    EXPECT_THAT(complaintOf(whole.substr(0, whole.size() - 7)), HasSubstr("32 facets"));
    EXPECT_THAT(complaintOf(whole + "x"), HasSubstr("32 facets"));
    EXPECT_THAT(complaintOf(whole.substr(0, 50)), HasSubstr("at least 84 bytes"));
    std::string broken = whole;
    const float bad = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(broken.data() + 84 + 50 * 4 + 12, &bad, sizeof bad);
    EXPECT_THAT(complaintOf(broken), HasSubstr("facet 5"));
    std::string huge = whole;
    const std::uint32_t count = 0xFFFFFFFF;
    std::memcpy(huge.data() + 80, &count, sizeof count);
    EXPECT_THAT(complaintOf(huge), HasSubstr("4294967295 facets"));
}

TEST(StlFile, NoDamageBringsItDown) {
    Random random(2, "damage");
    for (const std::string& whole :
         {kTriangle + kTriangle, stlBytes(tubeMesh(Vector3d::Zero(), Vector3d::UnitX(), 1, 4))}) {
        for (int i = 0; i < 2000; ++i) {
            std::string bytes = whole;
            for (int k = 0; k < 3; ++k)
                bytes[random.index(bytes.size())] = static_cast<char>(random.index(256));
            bytes.resize(random.index(4) ? bytes.size() : random.index(bytes.size()));
            const auto mesh = parseStl(bytes, "arm.stl");
            if (!mesh)
                continue;
            for (const auto& corners : mesh->triangles) {
                for (const std::uint32_t corner : corners)
                    ASSERT_TRUE(mesh->vertices.at(corner).allFinite());
            }
        }
    }
}

TEST(StlFile, CancelledAnywhereItStopsReading) {
    const TemporaryDirectory directory;
    const TriangleMesh tube = tubeMesh(Vector3d::Zero(), Vector3d::UnitX(), 1, 10000);
    std::string text = "solid\n";
    for (const auto& corners : tube.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const std::uint32_t corner : corners) {
            const Vector3d& p = tube.vertices[corner];
            text +=
                "vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
        }
        text += "endloop\nendfacet\n";
    }
    for (const std::string& bytes : {stlBytes(tube), text}) {
        writeText(directory / "tube.stl", bytes);
        int asked = 0;
        RunContext context;
        context.isCancelled = [&] { return ++asked < 0; };
        ASSERT_TRUE(readStl(directory / "tube.stl", context));
        const int total = asked;
        EXPECT_GT(total, 10 * 40000 / 4096) << "in every step of it";
        for (int last = 0; last < total; ++last) {
            asked = 0;
            context.isCancelled = [&] { return ++asked > last; };
            const auto mesh = readStl(directory / "tube.stl", context);
            ASSERT_FALSE(mesh) << last << " of " << total;
            EXPECT_THAT(mesh.error().message(), AllOf(HasSubstr("tube.stl"), HasSubstr("cancelled")));
            EXPECT_LE(asked - last, 4);
        }
    }
}

TEST(StlFile, AFileTooLargeForTheMemoryIsRefusedUnread) {
    const TemporaryDirectory directory;
    writeText(directory / "huge.stl", "solid");
    std::filesystem::resize_file(directory / "huge.stl", (std::uintmax_t{100} << 20U) + 1);
    EXPECT_THAT(readStl(directory / "huge.stl").error().message(), HasSubstr("at most 100 MB"));
}

TEST(StlFile, AFileThatIsNotThereIsNamed) {
    EXPECT_THAT(readStl("nowhere.stl").error().message(), HasSubstr("nowhere.stl"));
}

}  // namespace
}  // namespace skincal
