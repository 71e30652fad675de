#pragma once

#include <fmt/core.h>

#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace skincal {

/// What core has to say to people, kept as a pattern in English and what fills it, so that whoever shows it can say it
/// in the reader's language: files, logs and the command line take `english()`, the window translates pattern by
/// pattern (ui/texts/sentences.h). A piece that is a sentence of its own, such as "modules 3 and 7", fills another.
class Sentence {
  public:
    /// "module {}: its accelerometer is {:.0f} times as noisy as the others", checked at compile time. lupdate takes
    /// the pattern for translators wherever it reads `Sentence::saying("…"`. Text goes in as a variable, never as a
    /// literal: in that place lupdate reads a comment for the translator. What is counted has a pattern for one and
    /// another for more, as English does; languages with more forms say the second.
    template <typename... Args>
    [[nodiscard]] static Sentence saying(fmt::format_string<Args...> pattern, Args&&... args);

    /// Somebody else's words, the same in all languages: out of a file, or typed in.
    [[nodiscard]] static Sentence verbatim(std::string text);

    [[nodiscard]] bool empty() const { return pattern_.empty(); }
    void clear() { *this = Sentence(); }

    [[nodiscard]] std::string english() const;
    /// For matchers of tests that look into a text.
    explicit operator std::string() const { return english(); }

    /// What `translate` makes of each pattern, filled. One that is empty or can't be filled, a slip of the
    /// translator's, is said in English.
    using Translate = std::function<std::string(const char* pattern)>;
    [[nodiscard]] std::string said(const Translate& translate) const;

    friend bool operator==(const Sentence& a, const Sentence& b) { return a.english() == b.english(); }
    friend bool operator==(const Sentence& sentence, std::string_view english) { return sentence.english() == english; }
    /// In English, for tests and logs.
    friend std::ostream& operator<<(std::ostream& out, const Sentence& sentence);

  private:
    using Piece = std::variant<long long, unsigned long long, double, std::string, Sentence>;

    template <typename Value>
    [[nodiscard]] static Piece piece(Value&& value);

    std::string pattern_;  ///< "{}" where it is verbatim: there is nothing to translate
    std::vector<Piece> pieces_;
};

/// Of each.
[[nodiscard]] std::vector<std::string> english(const std::vector<Sentence>& sentences);

template <typename Value>
Sentence::Piece Sentence::piece(Value&& value) {
    using Plain = std::decay_t<Value>;
    static_assert(!std::is_same_v<Plain, bool> && !std::is_same_v<Plain, char>, "would be a number");
    if constexpr (std::is_unsigned_v<Plain>)
        return static_cast<unsigned long long>(value);
    else if constexpr (std::is_integral_v<Plain>)
        return static_cast<long long>(value);
    else if constexpr (std::is_floating_point_v<Plain>)
        return static_cast<double>(value);
    else if constexpr (std::is_same_v<Plain, Sentence>)
        return Sentence(std::forward<Value>(value));
    else
        return std::string(std::forward<Value>(value));
}

template <typename... Args>
Sentence Sentence::saying(fmt::format_string<Args...> pattern, Args&&... args) {
    const fmt::string_view text = pattern;
    Sentence sentence;
    sentence.pattern_.assign(text.data(), text.size());
    sentence.pieces_.reserve(sizeof...(args));
    (sentence.pieces_.push_back(piece(std::forward<Args>(args))), ...);
    return sentence;
}

}  // namespace skincal

/// In English, so that a sentence can fill another and be printed.
template <>
struct fmt::formatter<skincal::Sentence> : fmt::formatter<std::string> {
    template <typename Context>
    auto format(const skincal::Sentence& sentence, Context& context) const {
        return fmt::formatter<std::string>::format(sentence.english(), context);
    }
};
