#include "core/geometry/sentence.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <ostream>

namespace skincal {
namespace {

constexpr const char* kVerbatim = "{}";

}  // namespace

Sentence Sentence::verbatim(std::string text) {
    if (text.empty())
        return {};
    Sentence sentence;
    sentence.pattern_ = kVerbatim;
    sentence.pieces_.emplace_back(std::move(text));
    return sentence;
}

std::string Sentence::said(const Translate& translate) const {
    if (pieces_.size() == 1 && pattern_ == kVerbatim) {
        if (const auto* words = std::get_if<std::string>(&pieces_.front()))
            return *words;
    }
    fmt::dynamic_format_arg_store<fmt::format_context> values;
    for (const Piece& piece : pieces_) {
        if (const auto* inner = std::get_if<Sentence>(&piece))
            values.push_back(inner->said(translate));
        else if (const auto* integer = std::get_if<long long>(&piece))
            values.push_back(*integer);
        else if (const auto* natural = std::get_if<unsigned long long>(&piece))
            values.push_back(*natural);
        else if (const auto* number = std::get_if<double>(&piece))
            values.push_back(*number);
        else
            values.push_back(std::get<std::string>(piece));
    }
    const std::string translated = translate(pattern_.c_str());
    try {
        return fmt::vformat(translated.empty() ? pattern_ : translated, values);
    } catch (const fmt::format_error&) {
        return fmt::vformat(pattern_, values);
    }
}

std::string Sentence::english() const {
    return said([](const char* pattern) { return std::string(pattern); });
}

std::vector<std::string> english(const std::vector<Sentence>& sentences) {
    std::vector<std::string> texts;
    for (const Sentence& sentence : sentences)
        texts.push_back(sentence.english());
    return texts;
}

std::ostream& operator<<(std::ostream& out, const Sentence& sentence) {
    return out << sentence.english();
}

}  // namespace skincal
