#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

namespace skincal {

/// YAML as a tree of JSON, so that JsonCursor reads it and names places. Plain scalars that look like numbers become
/// numbers (".nan" and ".inf" stay text), tags are left out. OpenCV's "%YAML:1.0" is understood. Throws
/// FileErrorException: with line and column for bad syntax; for aliases, keys that are no scalars or there twice, more
/// than one document that holds something, more than 32 levels or 100,000 values.
[[nodiscard]] nlohmann::json parseYaml(std::string_view text, const std::filesystem::path& file);

/// XML of OpenCV's FileStorage as the tree that its YAML would be: an element with elements within is an object,
/// one named `data` a list of numbers, any other its text or number. The root must be <opencv_storage>. Throws as
/// above.
[[nodiscard]] nlohmann::json parseOpenCvXml(std::string_view text, const std::filesystem::path& file);

}  // namespace skincal
