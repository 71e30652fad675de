#include "app/skin_address.h"

#include "core/formats/template_json.h"

namespace skincal {

tl::expected<SkinAddress, std::string> skinAddress(const SkinArguments& arguments) {
    const auto line = parseLineAddress(QString::fromStdString(arguments.device));
    if (!line)
        return tl::unexpected(line.error().toStdString());
    SkinAddress address{*line, {paperHexagon(), triangleTemplate(), rectangleTemplate()}};
    for (const std::filesystem::path& file : arguments.templates) {
        auto own = readTemplateFile(file);
        if (!own)
            return tl::unexpected(own.error().message());
        std::erase_if(address.templates, [&](const ModuleTemplate& type) { return type.name == own->name; });
        address.templates.push_back(std::move(*own));
    }
    return address;
}

}  // namespace skincal
