#include "core/estimation/module_fit.h"

#include <Eigen/Geometry>
#include <cmath>

namespace skincal {

std::optional<RigidFit> fitModule(const BodySolution& solution, std::size_t module, const ModuleTemplate& type,
                                  const std::optional<Vector3d>& led) {
    const Skin& skin = *solution.input.skin;
    const auto& T_r_u = solution.solved.T_r_u[module];
    std::vector<Vector3d> own;
    std::vector<Vector3d> body;
    for (const GraphLink& link : solution.layout.graph.links()) {
        const bool isA = link.a == module;
        if ((!isA && link.b != module) || link.a == link.b)
            continue;
        const std::size_t neighbour = isA ? link.b : link.a;
        const auto port = static_cast<std::size_t>(isA ? link.a_port : link.b_port);
        const auto& T_r_n = solution.solved.T_r_u[neighbour];
        if (!T_r_n || port >= type.ports.size())
            continue;
        const Vector3d place = *T_r_n * skin.port(neighbour, isA ? link.b_port : link.a_port);
        // The far end of a cable says nothing.
        constexpr double kNear = 3;  // port radii
        if (T_r_u && (place - T_r_u->translation()).norm() > kNear * type.portRadius())
            continue;
        own.push_back(type.ports[port]);
        body.push_back(place);
    }
    if (led) {
        own.push_back(type.led);
        body.push_back(*led);
    }
    constexpr std::size_t kFixAPose = 3;
    if (own.size() < 2 || (own.size() < kFixAPose && !T_r_u))
        return std::nullopt;
    const Eigen::Map<const Eigen::Matrix3Xd> from(own.front().data(), 3, static_cast<Eigen::Index>(own.size()));
    const Eigen::Map<const Eigen::Matrix3Xd> to(body.front().data(), 3, static_cast<Eigen::Index>(body.size()));
    RigidFit fit;
    if (own.size() < kFixAPose)
        fit.T_r_u = makeIsometry(T_r_u->linear(), (to - T_r_u->linear() * from).rowwise().mean());
    else
        fit.T_r_u.matrix() = Eigen::umeyama(from, to, false);
    fit.rms = std::sqrt((fit.T_r_u * from - to).colwise().squaredNorm().mean());
    return fit;
}

std::optional<OtherTemplate> otherTemplate(const BodySolution& solution, std::size_t module,
                                           const std::optional<Vector3d>& led, double fits) {
    const Skin& skin = *solution.input.skin;
    const auto own = fitModule(solution, module, skin.templateOf(module), led);
    std::optional<OtherTemplate> best;
    for (const ModuleTemplate& type : skin.templates) {
        if (&type == &skin.templateOf(module))
            continue;
        const auto fit = fitModule(solution, module, type, led);
        if (own && fit && fit->rms < fits && fit->rms < own->rms / 3 && (!best || fit->rms < best->rms))
            best = OtherTemplate{&type, own->rms, fit->rms};
    }
    return best;
}

}  // namespace skincal
