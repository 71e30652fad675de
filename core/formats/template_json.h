#pragma once

#include <nlohmann/json.hpp>

#include "core/formats/json_cursor.h"
#include "core/skin/module_template.h"
#include "core/vision/camera_model.h"

namespace skincal {

/// The module template in a file of its own. The error names file and place.
[[nodiscard]] tl::expected<ModuleTemplate, FileError> readTemplateFile(const std::filesystem::path& file);

/// A module template as recording.md and body-model.md write it. Reading throws FileErrorException.
[[nodiscard]] ModuleTemplate readTemplate(const JsonCursor& cursor);
[[nodiscard]] nlohmann::ordered_json templateToJson(const ModuleTemplate& type);

/// Keys that the page does not name, with their JSON text; and back.
[[nodiscard]] std::map<std::string, std::string> unknownTemplateKeys(const JsonCursor& cursor);
void addKeys(nlohmann::ordered_json& json, const std::map<std::string, std::string>& keys);

[[nodiscard]] CameraModel readCamera(const JsonCursor& cursor);
[[nodiscard]] nlohmann::ordered_json cameraToJson(const CameraModel& camera);

}  // namespace skincal
