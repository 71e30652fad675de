#include "core/formats/json_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace skincal {
namespace {

constexpr int kMaxDepth = 64;

/// A value of a complaint, short enough for a line.
std::string shown(const nlohmann::json& value) {
    if (value.is_structured())
        return kindOf(value);
    std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return text.size() <= 40 ? text : text.substr(0, 37) + "…";
}

/// nlohmann's parser gives the byte; people want line and column.
std::string lineAndColumn(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte == 0 ? 0 : byte - 1, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n');
    const std::size_t column = start == std::string_view::npos ? before.size() + 1 : before.size() - start;
    return fmt::format("line {}, column {}", line, column);
}

/// For a number out of range nlohmann's parser gives no byte, only the number itself, between quotes.
std::string placeOfNumber(std::string_view text, std::string_view what) {
    const auto first = what.find('\'');
    const auto last = what.rfind('\'');
    if (first == std::string_view::npos || last <= first + 1)
        return {};
    const auto found = text.find(what.substr(first + 1, last - first - 1));
    return found == std::string_view::npos ? std::string() : lineAndColumn(text, found + 1);
}

/// What the parser itself lets pass and a reader must not: memory without end, keys that contradict each other.
class ParseLimits {
  public:
    explicit ParseLimits(const std::filesystem::path& file) : file_(file) {}

    void check(int depth, nlohmann::json::parse_event_t event, const nlohmann::json& value) {
        using Event = nlohmann::json::parse_event_t;
        const bool opens = event == Event::object_start || event == Event::array_start;
        if (opens && depth >= kMaxDepth)
            throw FileErrorException{{file_, "", fmt::format("expected at most {} levels of nesting", kMaxDepth)}};
        if ((opens || event == Event::value || event == Event::key) && ++count_ > kMaxJsonValues)
            throw FileErrorException{{file_, "", fmt::format("expected at most {} values and keys", kMaxJsonValues)}};
        if (event == Event::object_start)
            keys_.emplace_back();
        else if (event == Event::object_end)
            keys_.pop_back();
        else if (event == Event::key && !keys_.back().insert(value.get_ref<const std::string&>()).second)
            throw FileErrorException{
                {file_, "", fmt::format("expected each key of an object once, '{}' is there twice", shownKey(value))}};
    }

  private:
    static std::string shownKey(const nlohmann::json& key) {
        const auto& text = key.get_ref<const std::string&>();
        return text.size() <= 100 ? text : text.substr(0, 97) + "…";
    }

    const std::filesystem::path& file_;
    std::size_t count_ = 0;
    std::vector<std::set<std::string>> keys_;  ///< of the objects that are open
};

}  // namespace

std::string kindOf(const nlohmann::json& value) {
    switch (value.type()) {
        case nlohmann::json::value_t::null:
            return "null";
        case nlohmann::json::value_t::object:
            return "an object";
        case nlohmann::json::value_t::array:
            return "an array";
        case nlohmann::json::value_t::string:
            return "a string";
        case nlohmann::json::value_t::boolean:
            return "true or false";
        default:
            return "a number";
    }
}

void JsonCursor::fail(const std::string& problem) const {
    throw FileErrorException{{*file_, path_, problem}};
}

JsonCursor JsonCursor::child(const nlohmann::json& value, const std::string& step) const {
    const bool index = !step.empty() && step.front() == '[';
    return {value, *file_, path_.empty() || index ? path_ + step : path_ + "." + step};
}

bool JsonCursor::has(std::string_view key) const {
    return value_->is_object() && value_->contains(key);
}

bool JsonCursor::holds(std::string_view key) const {
    return has(key) && !value_->find(key)->is_null();
}

JsonCursor JsonCursor::at(std::string_view key) const {
    if (!value_->is_object())
        fail(fmt::format("expected an object, found {}", shown(*value_)));
    const auto found = value_->find(key);
    if (found == value_->end())
        fail(fmt::format("expected a key '{}', it is missing", key));
    return child(*found, std::string(key));
}

std::vector<JsonCursor> JsonCursor::array(std::size_t maxSize) const {
    if (!value_->is_array())
        fail(fmt::format("expected an array, found {}", shown(*value_)));
    if (value_->size() > maxSize)
        fail(fmt::format("expected at most {} entries, found {}", maxSize, value_->size()));
    std::vector<JsonCursor> items;
    items.reserve(value_->size());
    for (std::size_t i = 0; i < value_->size(); ++i)
        items.push_back(child((*value_)[i], fmt::format("[{}]", i)));
    return items;
}

std::vector<std::pair<std::string, JsonCursor>> JsonCursor::members() const {
    if (!value_->is_object())
        fail(fmt::format("expected an object, found {}", shown(*value_)));
    std::vector<std::pair<std::string, JsonCursor>> result;
    for (const auto& [key, value] : value_->items())
        result.emplace_back(key, child(value, key));
    return result;
}

std::map<std::string, std::string> JsonCursor::membersBut(std::span<const std::string_view> known) const {
    std::map<std::string, std::string> result;
    for (const auto& [key, value] : value_->items()) {
        if (std::find(known.begin(), known.end(), key) == known.end())
            result.emplace(key, value.dump());
    }
    return result;
}

double JsonCursor::number() const {
    if (!value_->is_number())
        fail(fmt::format("expected a number, found {}", shown(*value_)));
    const double number = value_->get<double>();
    if (!std::isfinite(number))
        fail("expected a finite number");
    return number;
}

double JsonCursor::number(double low, double high) const {
    const double n = number();
    if (n < low || n > high)
        fail(fmt::format("expected a number from {:g} to {:g}, found {}", low, high, shown(*value_)));
    return n;
}

std::int64_t JsonCursor::integer(std::int64_t low, std::int64_t high) const {
    const bool tooBig = value_->is_number_unsigned() &&
                        value_->get<std::uint64_t>() > static_cast<std::uint64_t>(std::max<std::int64_t>(high, 0));
    if (!value_->is_number_integer() || tooBig || value_->get<std::int64_t>() < low ||
        value_->get<std::int64_t>() > high)
        fail(fmt::format("expected an integer from {} to {}, found {}", low, high, shown(*value_)));
    return value_->get<std::int64_t>();
}

std::string JsonCursor::text() const {
    if (!value_->is_string())
        fail(fmt::format("expected a string, found {}", shown(*value_)));
    auto text = value_->get<std::string>();
    constexpr std::size_t kMaxText = 4096;
    if (text.size() > kMaxText)
        fail(fmt::format("expected at most {} characters, found {}", kMaxText, text.size()));
    return text;
}

Vector2d JsonCursor::vector2() const {
    const auto items = array(2);
    if (items.size() != 2)
        fail(fmt::format("expected 2 numbers, found {}", items.size()));
    return {items[0].number(), items[1].number()};
}

Vector3d JsonCursor::vector3() const {
    const auto items = array(3);
    if (items.size() != 3)
        fail(fmt::format("expected 3 numbers, found {}", items.size()));
    return {items[0].number(), items[1].number(), items[2].number()};
}

Vector3d JsonCursor::translation() const {
    const Vector3d t = vector3();
    if (t.cwiseAbs().maxCoeff() > kMaxTranslation)
        fail(fmt::format("expected a translation within {:g} m per axis (metres, not millimetres)", kMaxTranslation));
    return t;
}

nlohmann::json parseJson(std::string_view text, const std::filesystem::path& file) {
    // A byte order mark is harmless and some editors write one.
    if (text.substr(0, 3) == "\xEF\xBB\xBF")
        text.remove_prefix(3);
    ParseLimits limits(file);
    const auto check = [&limits](int depth, nlohmann::json::parse_event_t event, const nlohmann::json& value) {
        limits.check(depth, event, value);
        return true;
    };
    try {
        return nlohmann::json::parse(text.begin(), text.end(), check);
    } catch (const nlohmann::json::parse_error& error) {
        throw FileErrorException{{file, lineAndColumn(text, error.byte), "expected well-formed JSON"}};
    } catch (const nlohmann::json::out_of_range& error) {
        throw FileErrorException{
            {file, placeOfNumber(text, error.what()), "expected a number in the range of a double"}};
    }
}

}  // namespace skincal
