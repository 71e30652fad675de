#include "ui/scene3d/body_words.h"

#include <algorithm>
#include <cmath>

#include "ui/scene3d/body_actors.h"
#include "ui/scene3d/body_scene.h"

namespace skincal {
namespace {

constexpr std::size_t kMaxPatches = 8;

QColor toQt(const Rgb& colour) {
    return {colour[0], colour[1], colour[2]};
}

Rgb plainColour(bool dark) {
    return dark ? Rgb{168, 178, 192} : Rgb{150, 163, 181};
}

Rgb faded(const Rgb& colour, bool dark) {
    return mixed(colour, backgroundColour(dark), 0.5);
}

/// Three digits at most, no needless zeros.
QString number(double value) {
    return QString("%L1").arg(value, 0, 'g', 3);
}

bool somethingUnknown(const SceneLayout& layout, const ModuleValues& values) {
    return std::any_of(layout.modules.begin(), layout.modules.end(),
                       [&](const ShownModule& module) { return !values.values[module.index]; });
}

}  // namespace

std::optional<ModuleValues> valuesOf(const BodyModel& body, ColourMode mode) {
    switch (mode) {
        case ColourMode::Uncertainty:
            return uncertainties_mm(body);
        case ColourMode::Residual:
            return residuals_px(body);
        case ColourMode::ViewCount:
            return viewCounts(body);
        case ColourMode::LastView:
            return lastViews(body);
        default:
            return std::nullopt;
    }
}

std::vector<Rgb> coloursOf(const SceneLayout& layout, ColourMode mode, const std::optional<ModuleValues>& values,
                           std::span<const float> live, bool dark) {
    std::vector<Rgb> colours;
    colours.reserve(layout.modules.size());
    for (const ShownModule& module : layout.modules) {
        Rgb colour = plainColour(dark);
        if (mode == ColourMode::Patch) {
            colour = module.patch ? toRgb(patchColour(*module.patch)) : unknownColour(dark);
        } else if (mode == ColourMode::Values) {
            colour = module.index < live.size() && !std::isnan(live[module.index])
                         ? valueColour(static_cast<double>(live[module.index]), dark)
                         : unknownColour(dark);
        } else if (values) {
            const auto share = values->share(module.index);
            const auto known = [&](double at) {
                return mode == ColourMode::Deviation ? divergingColour(at) : valueColour(at, dark);
            };
            colour = share ? known(*share) : unknownColour(dark);
        }
        colours.push_back(layout.anyPlaced && !module.placed ? faded(colour, dark) : colour);
    }
    return colours;
}

Legend BodyWords::legend(const BodyModel& body, const SceneLayout& layout, ColourMode mode,
                         const std::optional<ModuleValues>& values, bool dark) {
    Legend legend;
    const auto bar = [&](const QString& low, const QString& high) {
        legend.low = low;
        legend.high = high;
    };
    const auto unknown = [&](const QString& text) {
        if (values && somethingUnknown(layout, *values))
            legend.more.push_back({toQt(unknownColour(dark)), text});
    };
    const bool any = values && std::any_of(values->values.begin(), values->values.end(),
                                           [](const auto& value) { return value.has_value(); });
    switch (mode) {
        case ColourMode::Patch:
            legend.title = tr("Modules per patch");
            for (std::size_t i = 0; i < std::min(kMaxPatches, body.patches.size()); ++i) {
                const BodyPatch& patch = body.patches[i];
                const Rgb colour = toRgb(patchColour(patch.id));
                const bool apart = layout.anyPlaced && !patch.T_body_patch;
                const QString count = QString("%L1").arg(patch.modules.size());
                const QString text = apart ? tr("%1: %2, not placed yet") : tr("%1: %2");
                legend.entries.push_back(
                    {toQt(apart ? faded(colour, dark) : colour), text.arg(BodyWords::patch(patch.id), count)});
            }
            if (body.patches.size() > kMaxPatches)
                legend.entries.push_back({QColor(), tr("and %L1 more").arg(body.patches.size() - kMaxPatches)});
            break;
        case ColourMode::Uncertainty:
            legend.title = tr("Uncertainty (1 σ)");
            if (any)
                bar(tr("%1 mm").arg(number(values->low)), tr("%1 mm").arg(number(values->high)));
            unknown(tr("not known yet"));
            break;
        case ColourMode::Residual:
            legend.title = tr("Mismatch in the pictures");
            if (any)
                bar(tr("%1 px").arg(number(values->low)), tr("%1 px").arg(number(values->high)));
            unknown(tr("in no picture"));
            break;
        case ColourMode::ViewCount:
            legend.title = tr("Views of each module");
            bar(number(values->low), number(values->high));
            break;
        case ColourMode::LastView:
            legend.title = tr("Last view of each module");
            if (any)
                bar(QString::fromStdString(body.views.front().name), QString::fromStdString(body.views.back().name));
            unknown(tr("in no picture"));
            break;
        case ColourMode::Deviation:
            legend.title = tr("Above the mesh");
            legend.isDiverging = true;
            if (any)
                bar(tr("−%1 mm").arg(number(values->high)), tr("+%1 mm").arg(number(values->high)));
            unknown(tr("beside the mesh"));
            break;
        case ColourMode::Plain:
            break;
        case ColourMode::Values:
            legend.title = tr("Value");
            bar(number(0), number(1));
            break;
    }
    return legend;
}

QString BodyWords::ellipsoids(double scale) {
    return scale > 1 ? tr("3 σ ellipsoids, × %L1").arg(scale, 0, 'f', 0) : tr("3 σ ellipsoids");
}

QString BodyWords::empty() {
    return tr("Nothing to show yet.\nThe body takes shape here as soon as something is known of its modules.");
}

QString BodyWords::caption(const SceneLayout& layout) {
    if (layout.apart.empty())
        return {};
    return layout.anyPlaced
               ? tr("Faded patches below the body are not placed yet: further views will show where they sit.")
               : tr("The patches take shape. Pictures will show how they sit on the body.");
}

QString BodyWords::description(const BodyModel* body, const SceneLayout& layout) {
    if (body == nullptr || layout.modules.empty())
        return empty();
    const auto placed = std::count_if(layout.modules.begin(), layout.modules.end(),
                                      [](const ShownModule& module) { return module.placed; });
    return tr("%L1 of %L2 modules have a place on the body.").arg(placed).arg(body->modules.size());
}

QString BodyWords::patch(PatchId id) {
    return tr("Patch %L1").arg(id.value);
}

QString BodyWords::module(ModuleId id) {
    return tr("Module %1").arg(id.value);
}

QString BodyWords::distance(double metres) {
    return tr("%L1 mm").arg(1e3 * metres, 0, 'f', 1);
}

QString BodyWords::hint() {
    return tr(
        "Drag to turn, Shift and drag to shift, wheel to zoom. Keys: arrows turn, + and - zoom, F fits the view, "
        "Home looks from the front, Page Up and Page Down go from module to module, Return does what a click does.");
}

}  // namespace skincal
