#include "core/geometry/sentence.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdint>
#include <sstream>
#include <stdexcept>

namespace skincal {
namespace {

/// A reader of German who has met but few words yet.
std::string german(const char* pattern) {
    const std::string english = pattern;
    if (english == "{} lies {:.1f} mm from {}")
        return "von {2} liegt {0} {1:.2f} mm entfernt";
    if (english == "module {}")
        return "Modul {}";
    if (english == "{} of {} seen")
        return "{} von {} und {} gesehen";
    return english;
}

TEST(Sentence, IsFilledInEnglish) {
    const std::string name = "elbow";
    EXPECT_EQ(Sentence::saying("no view shows it"), "no view shows it");
    EXPECT_EQ(Sentence::saying("module {}: {:.1f}° off, {} of {}", std::size_t{7}, 2.34, -3, name),
              "module 7: 2.3° off, -3 of elbow");
    EXPECT_EQ(Sentence::saying("{:.0f} px", 2.6F), "3 px");
    EXPECT_EQ(Sentence::saying("world {}", ~std::uint64_t{0}), "world 18446744073709551615");
}

TEST(Sentence, FillsAnotherAndIsTranslatedPieceByPiece) {
    const Sentence who = Sentence::saying("module {}", 4);
    const std::string where = "view2";
    const Sentence whole = Sentence::saying("{} lies {:.1f} mm from {}", who, 1.25, where);
    EXPECT_EQ(whole, "module 4 lies 1.2 mm from view2");
    EXPECT_EQ(whole.said(german), "von view2 liegt Modul 4 1.25 mm entfernt");
}

TEST(Sentence, IsSaidInEnglishWhereATranslationCannotBeFilled) {
    EXPECT_EQ(Sentence::saying("module {}", 3).said([](const char*) { return std::string(); }), "module 3");
    EXPECT_EQ(Sentence::saying("{} of {} seen", 3, 4).said(german), "3 of 4 seen");
}

TEST(Sentence, VerbatimWordsAreNeitherFilledNorTranslated) {
    const Sentence theirs = Sentence::verbatim("{} of {} seen");
    const auto nobodyAsks = [](const char* pattern) -> std::string { throw std::logic_error(pattern); };
    EXPECT_EQ(theirs.said(nobodyAsks), "{} of {} seen");
    EXPECT_TRUE(Sentence::verbatim("").empty());
}

TEST(Sentence, IsEmptyUntilItSaysSomething) {
    Sentence sentence;
    EXPECT_TRUE(sentence.empty());
    EXPECT_EQ(sentence, "");
    sentence = Sentence::saying("placed");
    EXPECT_FALSE(sentence.empty());
    sentence.clear();
    EXPECT_TRUE(sentence.empty());
}

TEST(Sentence, IsWhatItSays) {
    EXPECT_EQ(Sentence::saying("module {}", 4), Sentence::verbatim("module 4"));
    EXPECT_NE(Sentence::saying("module {}", 4), Sentence::saying("module {}", 5));
    std::ostringstream out;
    out << Sentence::saying("module {}", 4);
    EXPECT_EQ(out.str(), "module 4");
    EXPECT_EQ(fmt::format("<{}>", Sentence::saying("module {}", 4)), "<module 4>");
    EXPECT_THAT(english({Sentence::saying("a"), Sentence::verbatim("b")}), testing::ElementsAre("a", "b"));
}

}  // namespace
}  // namespace skincal
