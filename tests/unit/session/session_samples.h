#pragma once

#include <algorithm>
#include <sstream>
#include <string>

#include "core/geometry/random.h"
#include "core/session/session.h"
#include "core/simulation/world.h"
#include "core/workflow/simulated_recording.h"
#include "tests/wait_for.h"

namespace skincal::test {

/// Two patches of seven in three views, as LED positions: a body within some hundredths of a second.
[[nodiscard]] inline World smallWorld(std::uint64_t seed, ScanKind scan = ScanKind::Detections) {
    Scenario scenario = *findScenario("coded");
    scenario.views.scan = scan;
    scenario.cables = true;
    return buildWorld(scenario, seed);
}

[[nodiscard]] inline OpenedRecording smallRecording(std::uint64_t seed) {
    return openedFrom(recordingOf(smallWorld(seed)));
}

/// As text, every bit of every number: what is the same has the same text.
class Text {
  public:
    Text() { out_ << std::hexfloat; }
    [[nodiscard]] std::string str() const { return out_.str(); }

    template <class T>
    Text& operator<<(const T& value) {
        out_ << value << ' ';
        return *this;
    }
    template <class T>
    Text& operator<<(const std::optional<T>& value) {
        return value ? *this << *value : *this << "-";
    }
    Text& operator<<(const LinkKind& kind) { return *this << static_cast<int>(kind); }
    Text& operator<<(const Vector3d& v) { return *this << v.x() << v.y() << v.z(); }
    Text& operator<<(const Vector2d& v) { return *this << v.x() << v.y(); }
    Text& operator<<(const Link& l) {
        return *this << "\nlink" << l.a.value << l.a_port << l.b.value << l.b_port << l.decided;
    }
    Text& operator<<(const Skin& skin) {
        for (const ModuleTemplate& type : skin.templates)
            *this << "\ntype" << type.name;
        for (const SkinModule& module : skin.modules)
            *this << "\nmodule" << module.id.value << module.type;
        for (const Link& link : skin.links)
            *this << link;
        return *this;
    }
    Text& operator<<(const std::vector<GravityReading>& gravity) {
        for (const GravityReading& r : gravity)
            *this << "\ngravity" << r.pose << r.module.value << r.acceleration << r.sigma << r.samples;
        return *this;
    }
    Text& operator<<(const std::vector<LedDetection>& found) {
        for (const LedDetection& d : found)
            *this << "\nfound" << d.module.value << d.pixel << d.sigma_px;
        return *this;
    }
    Text& operator<<(const ViewDetections& view) {
        *this << "\nview" << view.name << view.found;
        std::vector<std::string> undetected;  // their order means nothing
        for (const Undetected& u : view.undetected)
            undetected.push_back(std::to_string(u.module.value) + ' ' + u.reason.english());
        std::sort(undetected.begin(), undetected.end());
        for (const std::string& u : undetected)
            *this << "\nundetected" << u;
        return *this;
    }
    Text& operator<<(const std::vector<FrameInfo>& frames) {
        for (const FrameInfo& frame : frames) {
            *this << "\nframe" << frame.file << frame.time_s;
            for (const LitModule& lit : frame.lit)
                *this << lit.module.value;
        }
        return *this;
    }
    Text& operator<<(const CameraModel& c) {
        *this << "\ncamera" << c.width << c.height << c.fx << c.fy << c.cx << c.cy
              << static_cast<int>(c.distortionModel);
        for (const double d : c.distortion)
            *this << d;
        return *this;
    }
    Text& operator<<(const Measurements& m) {
        *this << m.skin << m.gravity << m.camera;
        for (const ViewDetections& view : m.views)
            *this << view;
        return *this;
    }
    Text& operator<<(const Measured& m) {
        *this << m.skin << m.gravity;
        for (const ScannedView& view : m.views)
            *this << view.name << view.frames << view.decoded;
        return *this;
    }
    Text& operator<<(const Decisions& d) {
        for (const auto& [key, kind] : d.links)
            *this << "\nword" << key.a.value << key.a_port << key.b.value << key.b_port << kind;
        for (const int pose : d.droppedPoses)
            *this << "\ndropped" << pose;
        for (const std::string& view : d.droppedViews)
            *this << "\ndropped" << view;
        for (const auto& [key, decision] : d.detections)
            *this << "\ndecision" << key.view << key.module.value << decision.view << decision.module.value
                  << decision.verdict << decision.reason;
        return *this << d.camera;
    }
    Text& operator<<(const BodyModel& body) {
        for (const BodyModule& module : body.modules) {
            *this << "\nmodule" << module.id.value << module.status;
            if (module.T_body_module)
                *this << module.T_body_module->matrix();
            if (module.covariance)
                *this << *module.covariance;
        }
        return *this;
    }

  private:
    std::ostringstream out_;
};

template <class T>
[[nodiscard]] std::string textOf(const T& value) {
    return (Text() << value).str();
}

/// Changes one thing that an operator may decide. It may be what was decided already.
inline void decideSomething(const Measured& measured, Random& random, Decisions& decisions) {
    const ScannedView& view = measured.views[random.index(measured.views.size())];
    switch (random.index(8)) {
        case 0:
            decisions.links[LinkKey::of(measured.skin.links[random.index(measured.skin.links.size())])] =
                random.index(2) == 0 ? LinkKind::Cable : LinkKind::Adjacent;
            break;
        case 1:
            if (!decisions.links.empty())
                decisions.links.erase(decisions.links.begin());
            break;
        case 2:
            decisions.droppedPoses.insert(measured.gravity[random.index(measured.gravity.size())].pose);
            break;
        case 3:
            if (!decisions.droppedPoses.empty())
                decisions.droppedPoses.erase(decisions.droppedPoses.begin());
            break;
        case 4:
            if (!decisions.droppedViews.erase(view.name))
                decisions.droppedViews.insert(view.name);
            break;
        case 5:
        case 6: {
            const ModuleId module = view.decoded.found[random.index(view.decoded.found.size())].module;
            if (!decisions.detections.erase({view.name, module}))
                decisions.detections[{view.name, module}] = {view.name, module, "rejected",
                                                             random.index(2) == 0 ? "" : "a reflection"};
            break;
        }
        default:
            if (decisions.camera)
                decisions.camera->fx += random.normal();
    }
}

}  // namespace skincal::test
