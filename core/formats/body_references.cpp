#include "core/formats/body_references.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>

#include "core/formats/recording_parse.h"

namespace skincal {
namespace {

using TemplatesById = std::unordered_map<ModuleId, const ModuleTemplate*>;

void needModule(const TemplatesById& modules, ModuleId id, const JsonCursor& cursor) {
    if (modules.count(id) == 0)
        cursor.fail(fmt::format("expected the ids of modules, {} is none", id.value));
}

void checkFindings(const JsonCursor& root, const BodyModel& body, const TemplatesById& modules) {
    if (body.quality.findings.empty())
        return;
    std::set<std::string_view> views;
    for (const BodyView& view : body.views)
        views.insert(view.name);
    const std::vector<JsonCursor> cursors = root.at("quality").at("findings").array(kMaxLinks);
    for (std::size_t f = 0; f < body.quality.findings.size(); ++f) {
        const Finding& finding = body.quality.findings[f];
        for (const ModuleId id : finding.modules)
            needModule(modules, id, cursors[f].at("modules"));
        if (finding.view && views.count(*finding.view) == 0)
            cursors[f].at("view").fail(fmt::format("expected the name of a view, '{}' is none", *finding.view));
    }
}

}  // namespace

void checkBodyReferences(const JsonCursor& root, const BodyModel& body) {
    const auto entry = [&](const char* key, std::size_t i) { return root.at(key).array(kMaxLinks)[i]; };
    std::map<std::string, const ModuleTemplate*> types;
    for (std::size_t t = 0; t < body.templates.size(); ++t) {
        if (!types.emplace(body.templates[t].name, &body.templates[t]).second)
            entry("module_types", t).at("name").fail("expected a name of its own, it is taken");
    }
    std::set<PatchId> patches;
    for (std::size_t p = 0; p < body.patches.size(); ++p) {
        if (!patches.insert(body.patches[p].id).second)
            entry("patches", p).at("id").fail("expected an id of its own, it is taken");
    }
    TemplatesById modules;
    for (std::size_t m = 0; m < body.modules.size(); ++m) {
        const BodyModule& module = body.modules[m];
        const auto type = types.find(module.type);
        if (type == types.end())
            entry("modules", m).at("type").fail("expected a name from module_types, found '" + module.type + "'");
        if (!modules.emplace(module.id, type->second).second)
            entry("modules", m).at("id").fail(fmt::format("expected an id of its own, {} is taken", module.id.value));
        if (module.patch && patches.count(*module.patch) == 0)
            entry("modules", m)
                .at("patch")
                .fail(fmt::format("expected the id of a patch, {} is none", module.patch->value));
    }
    const auto need = [&](ModuleId id, const JsonCursor& cursor) { needModule(modules, id, cursor); };
    const std::vector<JsonCursor> patchCursors = root.at("patches").array(kMaxModules);
    for (std::size_t p = 0; p < body.patches.size(); ++p) {
        need(body.patches[p].origin, patchCursors[p].at("origin"));
        for (const ModuleId id : body.patches[p].modules)
            need(id, patchCursors[p].at("modules"));
    }
    const auto needPort = [&](ModuleId id, int port, const JsonCursor& cursor) {
        if (static_cast<std::size_t>(port) >= modules.at(id)->ports.size())
            cursor.fail(fmt::format("expected a port below {} of '{}', found {}", modules.at(id)->ports.size(),
                                    modules.at(id)->name, port));
    };
    const std::vector<JsonCursor> links = root.at("links").array(kMaxLinks);
    for (std::size_t l = 0; l < body.links.size(); ++l) {
        const Link& link = body.links[l].link;
        need(link.a, links[l].at("a"));
        need(link.b, links[l].at("b"));
        needPort(link.a, link.a_port, links[l].at("a_port"));
        needPort(link.b, link.b_port, links[l].at("b_port"));
    }
    const std::vector<JsonCursor> views = root.at("views").array(kMaxViews);
    for (std::size_t v = 0; v < body.views.size(); ++v) {
        for (const BodyObservation& observation : body.views[v].observations)
            need(observation.module, views[v].at("observations"));
    }
    checkFindings(root, body, modules);
}

}  // namespace skincal
