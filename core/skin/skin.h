#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/geometry/ids.h"
#include "core/skin/module_template.h"

namespace skincal {

enum class LinkKind { Adjacent, Cable };

struct SkinModule {
    ModuleId id;
    std::size_t type = 0;    ///< index into Skin::templates
    std::string uniqueId{};  ///< burnt into the module, whatever its number; empty where the network has none
};

/// A port-to-port connection as the network reported it; ports count from 0.
struct Link {
    ModuleId a;
    int a_port = 0;
    ModuleId b;
    int b_port = 0;
    std::optional<LinkKind> decided{};  ///< the operator's word, where given
};

struct HostLink {
    ModuleId module;
    int port = 0;
};

/// The skin as the network describes it: nothing here is estimated. Links may be reported from one side or both,
/// and may contradict each other; buildSkinGraph sorts that out.
struct Skin {
    std::vector<ModuleTemplate> templates;
    std::vector<SkinModule> modules;
    std::vector<Link> links;
    std::vector<HostLink> hostLinks;

    [[nodiscard]] const ModuleTemplate& templateOf(std::size_t module) const { return templates[modules[module].type]; }
    /// Port vector of a module, in its frame.
    [[nodiscard]] const Vector3d& port(std::size_t module, int port) const {
        return templateOf(module).ports[static_cast<std::size_t>(port)];
    }
    /// Position of each id in `modules`. Built on demand: keep the map where you look up often.
    [[nodiscard]] std::unordered_map<ModuleId, std::size_t> indexById() const;
};

/// What one accelerometer read at rest: specific force in the module frame, m/s^2.
struct GravityReading {
    int pose = 0;
    ModuleId module;
    Vector3d acceleration = Vector3d::Zero();
    std::optional<double> sigma{};  ///< standard deviation per axis of this (averaged) reading, m/s^2
    std::optional<int> samples{};
};

}  // namespace skincal
