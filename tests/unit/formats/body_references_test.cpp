// A body whose parts refer to what is not there is refused: whoever uses one may look things up blindly.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/formats/body_json.h"
#include "tests/unit/formats/random_body.h"

namespace skincal {
namespace {

using Json = nlohmann::ordered_json;

struct BadBody {
    const char* name;
    const char* pointer;
    Json value;
    const char* place;
    const char* words;
};

void PrintTo(const BadBody& bad, std::ostream* out) {
    *out << bad.name;
}

class BadBodyJson : public testing::TestWithParam<BadBody> {};

TEST_P(BadBodyJson, IsRefusedWithPlaceAndReason) {
    const BadBody& bad = GetParam();
    Json json = Json::parse(bodyToJson(test::randomBody(1)));
    const auto whole = parseBodyJson(json.dump(), "a.body.json");
    ASSERT_TRUE(whole) << whole.error().message();
    json[Json::json_pointer(bad.pointer)] = bad.value;
    const auto body = parseBodyJson(json.dump(), "a.body.json");
    ASSERT_FALSE(body);
    EXPECT_EQ(body.error().place, bad.place);
    EXPECT_THAT(body.error().problem, testing::HasSubstr(bad.words));
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadBodyJson,
    testing::Values(
        BadBody{"TypeTaken", "/module_types/0/name", "triangle", "module_types[1].name", "taken"},
        BadBody{"TypeUnknown", "/modules/4/type", "octagon", "modules[4].type", "found 'octagon'"},
        BadBody{"IdTaken", "/modules/1/id", 10, "modules[1].id", "10 is taken"},
        BadBody{"PatchTaken", "/patches/1/id", 0, "patches[1].id", "taken"},
        BadBody{"PatchUnknown", "/modules/3/patch", 9, "modules[3].patch", "9 is none"},
        BadBody{"OriginUnknown", "/patches/1/origin", 9, "patches[1].origin", "9 is none"},
        BadBody{"MemberUnknown", "/patches/0/modules/1", 9, "patches[0].modules", "9 is none"},
        BadBody{"LinkUnknown", "/links/0/b", 9, "links[0].b", "9 is none"},
        BadBody{"PortTooHigh", "/links/0/a_port", 5, "links[0].a_port", "a port below 4 of 'hex', found 5"},
        BadBody{"PortOfTheOtherEnd", "/links/0/b_port", 3, "links[0].b_port", "a port below 3 of 'triangle', found 3"},
        BadBody{"PortNegative", "/links/0/a_port", -1, "links[0].a_port", "from 0"},
        BadBody{"Kind", "/links/1/kind", "glue", "links[1].kind", "\"adjacent\", \"cable\", found \"glue\""},
        BadBody{"Verdict", "/views/0/observations/1/verdict", "maybe", "views[0].observations[1].verdict",
                "\"not found\", \"ambiguous\""},
        BadBody{"ObservedUnknown", "/views/0/observations/0/module", 9, "views[0].observations", "9 is none"},
        BadBody{"Trust", "/quality/verdict", "superb", "quality.verdict", "\"good\", \"usable\""},
        BadBody{"CovarianceOfFive", "/modules/0/covariance", {1, 2, 3, 4, 5}, "modules[0].covariance", "6 rows"},
        BadBody{
            "CovarianceRowOfFive", "/modules/0/covariance/3", {1, 2, 3, 4, 5}, "modules[0].covariance", "6 rows of 6"},
        BadBody{"QuaternionOfThree",
                "/modules/2/T_body_module/quaternion_xyzw",
                {0, 0, 1},
                "modules[2].T_body_module.quaternion_xyzw",
                "4 numbers, found 3"},
        BadBody{"FarAway",
                "/modules/2/T_body_module/translation",
                {0, 0, -1001},
                "modules[2].T_body_module.translation",
                "within 1000 m"},
        BadBody{"MisalignmentOfTwo",
                "/modules/1/accelerometer/misalignment",
                {0, 0},
                "modules[1].accelerometer.misalignment",
                "expected 3 numbers"},
        BadBody{"MisalignmentInDegrees",
                "/modules/1/accelerometer/misalignment",
                {0, 0, 4},
                "modules[1].accelerometer.misalignment",
                "in rad, at most pi long, it is 4 long"},
        BadBody{"SupportUnknown", "/modules/0/support", "faith", "modules[0].support",
                "\"pictures\", \"links and gravity\", found \"faith\""},
        BadBody{"SupportIsANumber", "/modules/0/support", 1, "modules[0].support", "a string, found 1"},
        BadBody{"SupportOfWhatIsNotPlaced", "/modules/5/support", "pictures", "modules[5].support", "expected null"},
        BadBody{"FindingsAreNoArray", "/quality/findings", "none", "quality.findings", "an array"},
        BadBody{"FindingIsNoObject", "/quality/findings/0", "none", "quality.findings[0]", "an object"},
        BadBody{"FindingKind", "/quality/findings/0/kind", "odd module", "quality.findings[0].kind",
                "\"moved module\", \"moved patch\""},
        BadBody{"FindingKindIsNull", "/quality/findings/0/kind", nullptr, "quality.findings[0].kind", "a string"},
        BadBody{"FindingModuleUnknown", "/quality/findings/0/modules/1", 9, "quality.findings[0].modules", "9 is none"},
        BadBody{"FindingModuleIsText", "/quality/findings/0/modules/1", "x", "quality.findings[0].modules[1]",
                "expected a"},
        BadBody{"FindingViewUnknown", "/quality/findings/1/view", "view9", "quality.findings[1].view",
                "'view9' is none"},
        BadBody{"FindingViewIsANumber", "/quality/findings/1/view", 0, "quality.findings[1].view", "a string, found 0"},
        BadBody{"FindingPoseNegative", "/quality/findings/2/pose", -1, "quality.findings[2].pose", "from 0"},
        BadBody{"FindingTextIsANumber", "/quality/findings/2/text", 1, "quality.findings[2].text", "a string, found 1"},
        BadBody{"OptionIsANumber", "/generator/options/method", 7, "generator.options.method", "a string, found 7"}),
    [](const testing::TestParamInfo<BadBody>& bad) { return bad.param.name; });

TEST(BodyJson, FindingsLackNeitherKindNorText) {
    for (const char* key : {"kind", "text"}) {
        Json json = Json::parse(bodyToJson(test::randomBody(1)));
        json["quality"]["findings"][0].erase(key);
        const auto body = parseBodyJson(json.dump(), "a.body.json");
        ASSERT_FALSE(body) << key;
        EXPECT_THAT(body.error().message(), testing::HasSubstr("quality.findings[0]"));
        EXPECT_THAT(body.error().message(), testing::HasSubstr(key));
    }
}

TEST(BodyJson, AnInfiniteConditionStaysInfinite) {
    BodyModel body;
    body.quality.condition["attachment"] = std::numeric_limits<double>::infinity();
    const auto back = parseBodyJson(bodyToJson(body), "b");
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(back->quality.condition, body.quality.condition);
}

TEST(BodyJson, ACovarianceThatIsNotFiniteIsNone) {
    BodyModel body = test::randomBody(5);
    body.modules[0].covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
    const auto back = parseBodyJson(bodyToJson(body), "b");
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_FALSE(back->modules[0].covariance);
}

TEST(BodyJson, TextThatIsNotUtf8IsMadeSo) {
    BodyModel body;
    body.body_frame = "a\xFF";
    const auto back = parseBodyJson(bodyToJson(body), "b");
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(back->body_frame, "a\uFFFD");
}

}  // namespace
}  // namespace skincal
