#include "core/formats/body_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/unit/formats/random_body.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

TEST(BodyJson, RoundTripKeepsEveryField) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const BodyModel a = test::randomBody(seed);
        const std::string text = bodyToJson(a);
        EXPECT_EQ(text, bodyToJson(a)) << "same model, same bytes";
        const auto b = parseBodyJson(text, "a.body.json");
        ASSERT_TRUE(b) << b.error().message();
        EXPECT_EQ(b->generator.recording_sha256, a.generator.recording_sha256);
        EXPECT_EQ(b->generator.options, a.generator.options);
        ASSERT_EQ(b->modules.size(), a.modules.size());
        for (std::size_t i = 0; i < a.modules.size(); ++i) {
            ASSERT_EQ(b->modules[i].T_body_module.has_value(), a.modules[i].T_body_module.has_value());
            if (a.modules[i].T_body_module) {
                EXPECT_TRUE(b->modules[i].T_body_module->isApprox(*a.modules[i].T_body_module, 1e-14));
                EXPECT_EQ(b->modules[i].T_body_module->translation(), a.modules[i].T_body_module->translation());
            }
            EXPECT_EQ(b->modules[i].status, a.modules[i].status);
            EXPECT_EQ(b->modules[i].covariance, a.modules[i].covariance);
            EXPECT_EQ(b->modules[i].seen, a.modules[i].seen);
        }
        for (const std::size_t i : {1U, 2U}) {
            EXPECT_EQ(b->modules[i].accelerometer->bias, a.modules[i].accelerometer->bias);
            EXPECT_EQ(b->modules[i].accelerometer->scale, a.modules[i].accelerometer->scale);
            EXPECT_EQ(b->modules[i].accelerometer->misalignment, a.modules[i].accelerometer->misalignment);
        }
        EXPECT_EQ(b->patches[0].modules, a.patches[0].modules);
        EXPECT_FALSE(b->patches[1].T_body_patch);
        EXPECT_EQ(b->links[0].distance, a.links[0].distance);
        EXPECT_EQ(b->links[1].kind, LinkKind::Cable);
        EXPECT_EQ(b->views[0].observations[1].verdict, ObservationVerdict::Ambiguous);
        EXPECT_EQ(b->views[0].observations[0].residual, a.views[0].observations[0].residual);
        EXPECT_EQ(b->quality.trust, Trust::Usable);
        EXPECT_EQ(b->quality.missing, a.quality.missing);
        EXPECT_EQ(b->quality.condition, a.quality.condition);
        ASSERT_EQ(b->quality.findings.size(), a.quality.findings.size());
        for (std::size_t i = 0; i < a.quality.findings.size(); ++i) {
            EXPECT_EQ(b->quality.findings[i].kind, a.quality.findings[i].kind);
            EXPECT_EQ(b->quality.findings[i].modules, a.quality.findings[i].modules);
            EXPECT_EQ(b->quality.findings[i].view, a.quality.findings[i].view);
            EXPECT_EQ(b->quality.findings[i].pose, a.quality.findings[i].pose);
            EXPECT_EQ(b->quality.findings[i].text, a.quality.findings[i].text);
        }
    }
}

TEST(BodyJson, HowLongItTookIsNoPartOfTheFile) {
    BodyModel body = test::randomBody(1);
    const std::string text = bodyToJson(body);
    body.quality.stages.front().seconds += 1;
    body.quality.stages.push_back({"another", 2, 3});
    EXPECT_EQ(bodyToJson(body), text);
}

TEST(BodyJson, EveryKindOfFindingHasAWordOfItsOwn) {
    std::set<std::string> words;
    for (const Finding::Kind kind : kFindingKinds) {
        BodyModel body = test::randomBody(1);
        body.quality.findings = {{kind, {}, {}, {}, Sentence::verbatim("what")}};
        const auto back = parseBodyJson(bodyToJson(body), "a");
        ASSERT_TRUE(back) << back.error().message();
        EXPECT_EQ(back->quality.findings.at(0).kind, kind);
        words.insert(std::string(name(kind)));
    }
    EXPECT_EQ(words.size(), kFindingKinds.size());
}

TEST(BodyJson, WritesWhatThePageSays) {
    const auto json = nlohmann::json::parse(bodyToJson(test::randomBody(1)));
    EXPECT_EQ(json["format"], "skincal-body");
    EXPECT_EQ(json["version"], 1);
    EXPECT_TRUE(json["modules"][5]["T_body_module"].is_null());
    EXPECT_EQ(json["modules"][0]["T_body_module"]["quaternion_xyzw"].size(), 4U);
    EXPECT_EQ(json["links"][1]["kind"], "cable");
    EXPECT_EQ(json["views"][0]["observations"][1]["verdict"], "ambiguous");
    EXPECT_EQ(json["modules"][0]["support"], "pictures");
    EXPECT_EQ(json["modules"][1]["support"], "links and gravity");
    EXPECT_TRUE(json["modules"][5]["support"].is_null());
    EXPECT_EQ(json["modules"][1]["accelerometer"]["misalignment"].size(), 3U);
    EXPECT_FALSE(json["modules"][2]["accelerometer"].contains("misalignment")) << "only where it is not zero";
    const auto expected = nlohmann::json::parse(R"([
        {"kind": "wrong link", "modules": [10, 11], "view": null, "pose": null, "text": "ports that do not meet"},
        {"kind": "bumped view", "modules": [10], "view": "view0", "pose": null, "text": "by 3 mm"},
        {"kind": "shaken pose", "modules": [], "view": null, "pose": 7, "text": "it did not rest"}])");
    EXPECT_EQ(json["quality"]["findings"], expected);
}

TEST(BodyJson, FilesFromBeforeTheseKeysAreRead) {
    auto json = nlohmann::json::parse(bodyToJson(test::randomBody(2)));
    json["quality"].erase("findings");
    for (auto& module : json["modules"]) {
        module.erase("support");
        if (module.contains("accelerometer"))
            module["accelerometer"].erase("misalignment");
    }
    const auto body = parseBodyJson(json.dump(), "x.body.json");
    ASSERT_TRUE(body) << body.error().message();
    EXPECT_THAT(body->quality.findings, testing::IsEmpty());
    EXPECT_TRUE(body->modules[1].accelerometer->misalignment.isZero(0));
    // What rests on pictures shows in the observations.
    EXPECT_TRUE(body->modules[0].seen);
    EXPECT_FALSE(body->modules[1].seen) << "its only observation is ambiguous";
}

TEST(BodyJson, AFindingNeedsItsKindAndItsText) {
    auto json = nlohmann::json::parse(bodyToJson(test::randomBody(2)));
    json["quality"]["findings"] = nlohmann::json::parse(R"([{"kind": "moved patch", "text": "what"}])");
    const auto body = parseBodyJson(json.dump(), "x.body.json");
    ASSERT_TRUE(body) << body.error().message();
    EXPECT_EQ(body->quality.findings.at(0).kind, Finding::Kind::MovedPatch);
}

TEST(BodyJson, BadFilesGiveTheirPlace) {
    const std::string good = bodyToJson(test::randomBody(2));
    const auto placeOf = [&](const std::function<void(nlohmann::json&)>& change) {
        auto json = nlohmann::json::parse(good);
        change(json);
        const auto result = parseBodyJson(json.dump(), "x.body.json");
        return result ? std::string("no error") : result.error().place;
    };
    EXPECT_EQ(placeOf([](auto& j) { j["format"] = "x"; }), "format");
    EXPECT_EQ(placeOf([](auto& j) { j["version"] = 7; }), "version");
    EXPECT_EQ(placeOf([](auto& j) {
                  j["modules"][0]["T_body_module"]["quaternion_xyzw"] = {0, 0, 0, 0};
              }),
              "modules[0].T_body_module.quaternion_xyzw");
    EXPECT_EQ(placeOf([](auto& j) { j["modules"][0]["covariance"].erase(0); }), "modules[0].covariance");
    EXPECT_EQ(placeOf([](auto& j) { j["links"][0]["kind"] = "glue"; }), "links[0].kind");
    EXPECT_EQ(placeOf([](auto& j) { j["views"][0]["observations"][0]["verdict"] = 3; }),
              "views[0].observations[0].verdict");
    EXPECT_EQ(placeOf([](auto& j) { j["modules"][0]["id"] = -4; }), "modules[0].id");
    EXPECT_EQ(placeOf([](auto&) {}), "no error");
}

TEST(BodyJson, NeedsOnlyWhatThePageNames) {
    auto json = nlohmann::json::parse(bodyToJson(test::randomBody(2)));
    json["generator"] = nlohmann::json::object();
    json["quality"] = nlohmann::json::object();
    for (auto& link : json["links"])
        link.erase("reason");
    const auto body = parseBodyJson(json.dump(), "x.body.json");
    ASSERT_TRUE(body) << body.error().message();
    EXPECT_EQ(body->quality.modulesTotal, 6U);
}

TEST(BodyJson, CountsPlacedModulesItself) {
    auto json = nlohmann::json::parse(bodyToJson(test::randomBody(2)));
    json["quality"]["modules_placed"] = 100;
    json["quality"]["modules_total"] = 100;
    const auto body = parseBodyJson(json.dump(), "x.body.json");
    ASSERT_TRUE(body) << body.error().message();
    EXPECT_EQ(body->quality.modulesPlaced, 5U);
    EXPECT_EQ(body->quality.modulesTotal, 6U);
}

TEST(BodyJson, FilesAreReadAndWritten) {
    const test::TemporaryDirectory directory;
    ASSERT_TRUE(writeBody(test::randomBody(3), directory / "a.body.json"));
    EXPECT_TRUE(readBody(directory / "a.body.json"));
    EXPECT_FALSE(readBody(directory / "none.body.json"));
    EXPECT_FALSE(writeBody(test::randomBody(3), directory / "no/such/place.json"));
}

}  // namespace
}  // namespace skincal
