#include "core/formats/truth_json.h"

#include <fmt/format.h>

#include <unordered_set>

#include "core/formats/files.h"
#include "core/formats/json_cursor.h"
#include "core/formats/recording_parse.h"

namespace skincal {
namespace {

using Json = nlohmann::ordered_json;

Isometry3d readPose(const JsonCursor& cursor) {
    Isometry3d T = Isometry3d::Identity();
    const auto rows = cursor.at("R").array(3);
    if (rows.size() != 3)
        cursor.at("R").fail(fmt::format("expected 3 rows, found {}", rows.size()));
    for (Eigen::Index i = 0; i < 3; ++i)
        T.linear().row(i) = rows[static_cast<std::size_t>(i)].vector3().transpose();
    T.translation() = cursor.at("t").translation();
    if (!isRigid(T, 1e-4))
        cursor.at("R").fail("expected a rotation matrix");
    return T;
}

void putPose(Json& json, const Isometry3d& T) {
    json["R"] = Json::array();
    for (int i = 0; i < 3; ++i)
        json["R"].push_back({T.linear()(i, 0), T.linear()(i, 1), T.linear()(i, 2)});
    json["t"] = {T.translation().x(), T.translation().y(), T.translation().z()};
}

}  // namespace

tl::expected<Truth, FileError> parseTruthJson(std::string_view text, const std::filesystem::path& file) {
    try {
        const nlohmann::json json = parseJson(text, file);
        const JsonCursor root(json, file);
        Truth truth;
        std::unordered_set<ModuleId> ids;
        for (const JsonCursor& item : root.at("modules").array(kMaxModules)) {
            TrueModule module;
            module.id = ModuleId(static_cast<std::uint32_t>(item.at("id").integer(1, 0xFFFFFFFFLL)));
            if (!ids.insert(module.id).second)
                item.at("id").fail(fmt::format("expected an id of its own, {} is taken", module.id.value));
            module.patch = item.holds("patch") ? static_cast<int>(item.at("patch").integer(0, 1'000'000)) : 0;
            module.T_body_module = readPose(item);
            truth.modules.push_back(module);
        }
        if (root.holds("views")) {
            for (const JsonCursor& item : root.at("views").array(kMaxViews))
                truth.views.push_back(
                    {item.holds("name") ? item.at("name").text() : fmt::format("view{}", truth.views.size()),
                     readPose(item)});
        }
        if (root.holds("pixels")) {
            for (const JsonCursor& item : root.at("pixels").array(kMaxModules * 100)) {
                const auto fields = item.array(4);
                if (fields.size() != 4)
                    item.fail(fmt::format("expected [view, module, x, y], found {} entries", fields.size()));
                truth.pixels.push_back({fields[0].text(),
                                        ModuleId(static_cast<std::uint32_t>(fields[1].integer(1, 0xFFFFFFFFLL))),
                                        {fields[2].number(), fields[3].number()}});
            }
        }
        return truth;
    } catch (const FileErrorException& exception) {
        return tl::unexpected(exception.error);
    }
}

tl::expected<Truth, FileError> readTruth(const std::filesystem::path& file) {
    const auto text = readFile(file, kMaxJsonBytes);
    if (!text)
        return tl::unexpected(text.error());
    return parseTruthJson(*text, file);
}

tl::expected<void, FileError> writeTruth(const Truth& truth, const std::filesystem::path& file) {
    Json json;
    json["modules"] = Json::array();
    for (const TrueModule& module : truth.modules) {
        Json entry;
        entry["id"] = module.id.value;
        entry["patch"] = module.patch;
        putPose(entry, module.T_body_module);
        json["modules"].push_back(std::move(entry));
    }
    json["views"] = Json::array();
    for (const TrueView& view : truth.views) {
        Json entry;
        entry["name"] = view.name;
        putPose(entry, view.T_body_camera);
        json["views"].push_back(std::move(entry));
    }
    json["pixels"] = Json::array();
    for (const TruePixel& pixel : truth.pixels)
        json["pixels"].push_back({pixel.view, pixel.module.value, pixel.pixel.x(), pixel.pixel.y()});
    return writeFileAtomically(file, json.dump(1) + "\n");
}

}  // namespace skincal
