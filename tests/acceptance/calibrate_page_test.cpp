// What `skincal calibrate` tells a person and a script of a recording with faults.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/formats/body_json.h"
#include "tests/acceptance/program.h"

namespace skincal {
namespace {

using test::Outcome;
using test::run;
using testing::HasSubstr;

std::vector<std::string> linesOf(const std::string& page) {
    std::istringstream in(page);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);)
        lines.push_back(line);
    return lines;
}

std::size_t columnsOf(const std::string& line) {
    return static_cast<std::size_t>(
        std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// The page with every run of blanks as one: sentences as they were before they were wrapped.
std::string unwrapped(const std::string& page) {
    std::istringstream in(page);
    std::string text;
    for (std::string word; in >> word;)
        text += (text.empty() ? "" : " ") + word;
    return text;
}

std::size_t countOf(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

class FaultsOnThePage : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        directory_ = std::make_unique<test::TemporaryDirectory>();
        ASSERT_EQ(run("simulate faults -o " + at("f.skinrec")).code, 0);
        page_ = run("calibrate " + at("f.skinrec") + " -o " + at("page.json"));
        json_ = run("calibrate --json " + at("f.skinrec") + " -o " + at("json.json"));
    }
    static void TearDownTestSuite() { directory_.reset(); }
    static std::string at(const std::string& name) { return (*directory_ / name).string(); }

    static inline std::unique_ptr<test::TemporaryDirectory> directory_;
    static inline Outcome page_;
    static inline Outcome json_;
};

TEST_F(FaultsOnThePage, EveryFindingIsPrintedOnceAndNoLineIsTooLong) {
    const auto body = readBody(at("page.json"));
    ASSERT_TRUE(body) << body.error().message();
    ASSERT_FALSE(body->quality.findings.empty());
    const std::string text = unwrapped(page_.output);
    for (const Finding& finding : body->quality.findings)
        EXPECT_EQ(countOf(text, unwrapped(finding.text.english())), 1U) << finding.text;
    for (const Sentence& warning : body->quality.warnings)
        EXPECT_EQ(countOf(text, unwrapped(warning.english())), 1U) << warning;
    for (const std::string& line : linesOf(page_.output)) {
        EXPECT_TRUE(columnsOf(line) <= 100 || line.starts_with("body model")) << line;
        EXPECT_FALSE(line.ends_with(' ')) << line;
    }
}

TEST_F(FaultsOnThePage, WhatItTookAndWhatPosesRestOnAreTold) {
    EXPECT_THAT(page_.output, testing::ContainsRegex("\ntime +[0-9.]+ s \\(initial estimate [0-9.]+ s, "));
    EXPECT_THAT(unwrapped(page_.output), testing::ContainsRegex("\\), [0-9]+ iterations verdict"));
    const auto body = readBody(at("page.json"));
    ASSERT_TRUE(body);
    const auto unseen = std::count_if(body->modules.begin(), body->modules.end(),
                                      [](const BodyModule& m) { return m.T_body_module && !m.seen; });
    EXPECT_EQ(countOf(page_.output, "resting on links and gravity alone: "), unseen > 0 ? 1U : 0U);
}

TEST_F(FaultsOnThePage, ScriptsGetTheSame) {
    const auto json = nlohmann::json::parse(json_.output);
    const auto file = nlohmann::json::parse(test::readText(at("json.json")));
    EXPECT_EQ(json["findings"], file["quality"]["findings"]);
    EXPECT_EQ(json["method"], "joint");
    EXPECT_EQ(json["modules_seen"].get<int>() + json["modules_on_links_and_gravity"].get<int>(),
              json["modules_placed"].get<int>());
    double seconds = 0;
    int iterations = 0;
    std::set<std::string> names;
    for (const auto& stage : json["stages"]) {
        EXPECT_TRUE(names.insert(stage["stage"].get<std::string>()).second) << "each stage once";
        seconds += stage["seconds"].get<double>();
        iterations += stage["iterations"].get<int>();
    }
    EXPECT_THAT(names, testing::IsSupersetOf({"initial estimate", "coarse adjustment", "joint adjustment"}));
    EXPECT_NEAR(json["seconds"].get<double>(), seconds, 1e-9);
    EXPECT_EQ(json["iterations"], iterations);
    EXPECT_GT(iterations, 0);
}

TEST_F(FaultsOnThePage, TheSameRecordingGivesTheSameBytes) {
    EXPECT_EQ(test::readText(at("page.json")), test::readText(at("json.json")));
}

}  // namespace
}  // namespace skincal
