#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/formats/file_error.h"
#include "core/geometry/se3.h"

namespace skincal {

/// Above this a file is refused, whatever its keys mean: each value takes memory many times its length in the text.
inline constexpr std::size_t kMaxJsonValues = 10'000'000;

/// No body is larger than this, m.
inline constexpr double kMaxTranslation = 1'000;

/// Carries a FileError out of nested reading; caught where a reader ends, never seen by callers.
struct FileErrorException {
    FileError error;
};

/// A place in a JSON file that knows its path, so that every complaint names it. All accessors throw
/// FileErrorException with the path and what was expected.
class JsonCursor {
  public:
    JsonCursor(const nlohmann::json& value, const std::filesystem::path& file, std::string path = {})
        : value_(&value), file_(&file), path_(std::move(path)) {}

    [[noreturn]] void fail(const std::string& problem) const;

    [[nodiscard]] bool has(std::string_view key) const;
    /// True for a key that is there and not null.
    [[nodiscard]] bool holds(std::string_view key) const;
    [[nodiscard]] JsonCursor at(std::string_view key) const;  ///< fails where the key is missing
    [[nodiscard]] std::vector<JsonCursor> array(std::size_t maxSize) const;
    /// Members of an object, by key.
    [[nodiscard]] std::vector<std::pair<std::string, JsonCursor>> members() const;

    /// JSON text of the members that are not among `known`, by key.
    [[nodiscard]] std::map<std::string, std::string> membersBut(std::span<const std::string_view> known) const;

    [[nodiscard]] double number() const;  ///< finite
    [[nodiscard]] double number(double low, double high) const;
    [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const;
    [[nodiscard]] std::string text() const;
    [[nodiscard]] Vector2d vector2() const;
    [[nodiscard]] Vector3d vector3() const;
    [[nodiscard]] Vector3d translation() const;  ///< each axis within kMaxTranslation
    [[nodiscard]] const nlohmann::json& json() const { return *value_; }
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    [[nodiscard]] JsonCursor child(const nlohmann::json& value, const std::string& step) const;

    const nlohmann::json* value_;
    const std::filesystem::path* file_;
    std::string path_;
};

/// Parses text as JSON; throws FileErrorException with line and column. Numbers out of range and keys
/// that an object holds twice are refused; nesting and the count of values and keys are limited, so that hostile files
/// exhaust neither stack nor memory.
[[nodiscard]] nlohmann::json parseJson(std::string_view text, const std::filesystem::path& file);

/// What a value is, for messages: "a string", "an object", …
[[nodiscard]] std::string kindOf(const nlohmann::json& value);

}  // namespace skincal
