#include "core/formats/export_csv.h"

#include <fmt/format.h>

#include <algorithm>

namespace skincal {

std::string exportCsv(const BodyModel& body) {
    std::string csv = "id,type,patch,status,x,y,z,qx,qy,qz,qw\n";
    for (const BodyModule& module : body.modules) {
        // A comma or a quote inside a text would shift the columns.
        std::string status = module.status.english();
        std::string type = module.type;
        for (std::string* text : {&status, &type})
            std::replace_if(
                text->begin(), text->end(), [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ';');
        csv += fmt::format("{},{},{},{}", module.id.value, type,
                           module.patch ? fmt::format("{}", module.patch->value) : "", status);
        if (module.T_body_module) {
            const Vector3d t = module.T_body_module->translation();
            const Quaterniond q(module.T_body_module->linear());
            csv += fmt::format(",{},{},{},{},{},{},{}\n", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
        } else {
            csv += ",,,,,,,\n";
        }
    }
    return csv;
}

}  // namespace skincal
