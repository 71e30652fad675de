#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "core/estimation/compare.h"
#include "core/formats/body_json.h"
#include "core/formats/truth_json.h"
#include "core/workflow/calibrate.h"

namespace skincal {
namespace {

struct Solved {
    BodyModel body;
    std::vector<NamedPose> real;
    std::optional<BodyComparison> difference;

    /// The difference over the modules that another result places.
    [[nodiscard]] std::optional<BodyComparison> differenceWhere(const BodyModel& placed) const {
        std::vector<NamedPose> found;
        for (std::size_t u = 0; u < body.modules.size(); ++u) {
            if (body.modules[u].T_body_module && placed.modules[u].T_body_module)
                found.push_back({body.modules[u].id, *body.modules[u].T_body_module});
        }
        const auto result = compareBodies(found, real);
        return result ? std::optional(*result) : std::nullopt;
    }
};

Solved solve(const std::filesystem::path& directory, Method method = CalibrateOptions{}.method) {
    const auto recording = readRecording(directory);
    const auto truth = readTruth(directory / "truth.json");
    if (!recording || !truth)
        throw std::runtime_error("the test's recording can't be read: " + directory.string());
    CalibrateOptions options;
    options.method = method;
    auto body = calibrate(*recording, framesOf(directory, *recording), options);
    if (!body)
        throw std::runtime_error(body.error().message);
    std::vector<NamedPose> real;
    for (const TrueModule& module : truth->modules)
        real.push_back({module.id, module.T_body_module});
    Solved solved{std::move(*body), std::move(real), std::nullopt};
    solved.difference = solved.differenceWhere(solved.body);
    return solved;
}

std::filesystem::path recordingNamed(const std::string& name) {
    return std::filesystem::path(SKINCAL_TEST_DATA) / "recordings" / (name + ".skinrec");
}

class RecordingsOfOthersTable : public testing::TestWithParam<std::string> {};

TEST_P(RecordingsOfOthersTable, AreSolvedThreeTimesBetterThanByThePaper) {
    const Solved ours = solve(recordingNamed(GetParam()));
    const Solved paper = solve(recordingNamed(GetParam()), Method::Paper);
    EXPECT_EQ(ours.body.quality.modulesPlaced, ours.body.quality.modulesTotal);
    ASSERT_TRUE(ours.difference);
    RecordProperty("position_rms_um", static_cast<int>(1e6 * ours.difference->positionRms));
    EXPECT_LT(ours.difference->positionRms, 1e-3);
    EXPECT_LT(ours.difference->rotationRms, 1 * kDegree);
    ASSERT_TRUE(paper.difference);
    const auto same = ours.differenceWhere(paper.body);
    ASSERT_TRUE(same);
    EXPECT_LT(same->positionRms, paper.difference->positionRms / 3);
}

INSTANTIATE_TEST_SUITE_P(Recordings, RecordingsOfOthersTable,
                         testing::Values("cylinder-cables-detections", "flat-detections", "freeform-detections",
                                         "freeform-single-images", "outliers-detections"),
                         [](const auto& parameter) {
                             std::string name = parameter.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(RecordingsOfOthers, FalseDetectionsAreNamedAndNoTrueOneIs) {
    const auto directory = recordingNamed("outliers-detections");
    const Solved ours = solve(directory);
    const auto truth = readTruth(directory / "truth.json");
    std::map<std::pair<std::string, ModuleId>, Vector2d> real;
    for (const TruePixel& pixel : truth->pixels)
        real[{pixel.view, pixel.module}] = pixel.pixel;
    for (const BodyView& view : ours.body.views) {
        for (const BodyObservation& o : view.observations) {
            const bool isFalse = (*o.pixel - real.at({view.name, o.module})).norm() > 3;
            EXPECT_EQ(o.verdict == ObservationVerdict::Rejected, isFalse) << view.name << " " << o.module.value;
            EXPECT_EQ(o.reason.empty(), !isFalse);
        }
    }
}

TEST(RecordingsOfOthers, CablesAreToldFromNeighbours) {
    for (const auto& [name, method] : {std::pair("cylinder-cables-detections", Method::Joint),
                                       {"outliers-detections", Method::Joint},
                                       {"outliers-detections", Method::Sturdy}}) {
        const auto directory = recordingNamed(name);
        const Solved ours = solve(directory, method);
        const auto truth = readTruth(directory / "truth.json");
        std::map<ModuleId, int> patch;
        for (const TrueModule& module : truth->modules)
            patch[module.id] = module.patch;
        for (const BodyLink& link : ours.body.links)
            EXPECT_EQ(link.kind == LinkKind::Cable, patch[link.link.a] != patch[link.link.b]) << link.reason;
    }
}

class PicturesTable : public testing::TestWithParam<std::string> {};

TEST_P(PicturesTable, ShowEveryVisibleLedAndNothingElse) {
    const auto directory = recordingNamed(GetParam());
    const auto recording = readRecording(directory);
    ASSERT_TRUE(recording) << recording.error().message();
    const auto truth = readTruth(directory / "truth.json");
    ASSERT_TRUE(truth);
    const auto measurements = measure(*recording, framesOf(directory, *recording));
    ASSERT_TRUE(measurements) << measurements.error().message;
    std::map<ModuleId, Isometry3d> poses;
    for (const TrueModule& module : truth->modules)
        poses[module.id] = module.T_body_module;
    const auto index = recording->skin.indexById();
    std::size_t found = 0;
    double squares = 0;
    double count = 0;
    for (std::size_t v = 0; v < measurements->views.size(); ++v) {
        for (const LedDetection& d : measurements->views[v].found) {
            // Also those that the other program's rule of thumb calls hidden: if they were found, then where they are.
            const Vector3d led = poses[d.module] * recording->skin.templateOf(index.at(d.module)).led;
            const auto real = recording->camera.project(truth->views[v].T_body_camera.inverse() * led);
            ASSERT_TRUE(real);
            EXPECT_LT((d.pixel - *real).norm(), 1.0) << d.module.value;
            squares += (d.pixel - *real).squaredNorm();
            count += 2;
        }
        for (const TruePixel& pixel : truth->pixels) {
            const auto& all = measurements->views[v].found;
            if (pixel.view == measurements->views[v].name)
                found += std::any_of(all.begin(), all.end(), [&](const auto& d) { return d.module == pixel.module; })
                             ? 1U
                             : 0U;
        }
    }
    EXPECT_GE(static_cast<double>(found), 0.99 * static_cast<double>(truth->pixels.size()));
    EXPECT_LT(std::sqrt(squares / count), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Scans, PicturesTable, testing::Values("freeform-single-images", "freeform-coded-one-view"),
                         [](const auto& parameter) {
                             std::string name = parameter.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(RecordingsOfOthers, TheSameRecordingGivesTheSameBody) {
    for (const Method method : {Method::Sturdy, Method::Joint}) {
        const Solved a = solve(recordingNamed("flat-detections"), method);
        const Solved b = solve(recordingNamed("flat-detections"), method);
        for (std::size_t u = 0; u < a.body.modules.size(); ++u) {
            EXPECT_TRUE(a.body.modules[u].T_body_module->matrix() == b.body.modules[u].T_body_module->matrix());
            EXPECT_EQ(a.body.modules[u].covariance, b.body.modules[u].covariance);
        }
        EXPECT_EQ(bodyToJson(a.body), bodyToJson(b.body));
    }
}

}  // namespace
}  // namespace skincal
