#include "app/known_templates.h"

#include "core/formats/template_json.h"

namespace skincal {

tl::expected<std::vector<ModuleTemplate>, FileError> knownTemplates(const std::vector<std::filesystem::path>& files) {
    std::vector<ModuleTemplate> templates{paperHexagon(), triangleTemplate(), rectangleTemplate()};
    for (const std::filesystem::path& file : files) {
        auto own = readTemplateFile(file);
        if (!own)
            return tl::unexpected(own.error());
        std::erase_if(templates, [&](const ModuleTemplate& type) { return type.name == own->name; });
        templates.push_back(std::move(*own));
    }
    return templates;
}

}  // namespace skincal
