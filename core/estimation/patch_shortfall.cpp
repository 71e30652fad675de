#include "core/estimation/patch_shortfall.h"

#include <algorithm>
#include <map>

#include "core/estimation/missing_data.h"

namespace skincal {
namespace {

/// Detections of each patch in each view, whatever became of them.
std::map<std::pair<std::size_t, std::size_t>, int> sightingCounts(const ShortfallSearch& search) {
    std::map<std::pair<std::size_t, std::size_t>, int> counts;
    for (const PixelObservation& o : search.solution.input.pixels)
        ++counts[{search.solution.layout.patchOf[o.module], o.view}];
    return counts;
}

std::vector<std::string> viewsOfPatch(const ShortfallSearch& search, std::size_t k) {
    std::vector<std::string> views;
    for (const auto& [where, count] : sightingCounts(search)) {
        if (where.first == k && count >= search.options.ledsOfAPose)
            views.push_back(search.viewName(where.second));
    }
    return views;
}

/// Placed patches at the other end of a cable: where a patch that is placed nowhere is likely to be.
std::vector<PatchId> placedNeighbours(const ShortfallSearch& search, std::size_t k) {
    const SkinLayout& layout = search.solution.layout;
    std::vector<PatchId> neighbours;
    for (const GraphLink& link : layout.graph.links()) {
        for (const auto& [own, other] : {std::pair(link.a, link.b), std::pair(link.b, link.a)}) {
            if (layout.patchOf[own] == k && layout.patchOf[other] != k &&
                search.solution.body.T_r_o[layout.patchOf[other]])
                neighbours.push_back(search.patch(layout.patchOf[other]).id);
        }
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    return neighbours;
}

Shortfall::Kind kindOf(NotPlaced reason) {
    switch (reason) {
        case NotPlaced::Unseen:
            return Shortfall::Kind::PatchUnseen;
        case NotPlaced::NeverWithPlaced:
            return Shortfall::Kind::PatchNeverWithPlaced;
        case NotPlaced::Contradicted:
            return Shortfall::Kind::PatchContradicted;
        case NotPlaced::TwoPlaces:
            return Shortfall::Kind::UndecidedViews;
        default:
            return Shortfall::Kind::PatchSeenTooLittle;
    }
}

}  // namespace

void findUnplacedPatches(ShortfallSearch& search) {
    const auto& placed = search.solution.body.T_r_o;
    const bool any = std::any_of(placed.begin(), placed.end(), [](const auto& T) { return T.has_value(); });
    for (std::size_t k = 0; k < placed.size(); ++k) {
        const PatchEvidence& evidence = search.solution.evidence[k];
        if (placed[k])
            continue;
        const NotPlaced reason = reasonNotPlaced(search.patch(k), evidence, search.options.ledsOfAPose, any);
        // What gravity lacks is told by modules, for all patches together.
        if (reason == NotPlaced::ShapeUnknown)
            continue;
        Shortfall shortfall{kindOf(reason)};
        shortfall.patches = {search.patch(k).id};
        shortfall.views = viewsOfPatch(search, k);
        shortfall.text = whyNotPlaced(search.skin(), search.patch(k), evidence, search.options.ledsOfAPose, any);
        const auto neighbours = placedNeighbours(search, k);
        if ((reason == NotPlaced::Unseen || reason == NotPlaced::NeverWithPlaced) && !neighbours.empty())
            shortfall.text = Sentence::saying("{} (it is wired to {})", shortfall.text, listed(neighbours));
        search.found.push_back(std::move(shortfall));
    }
}

namespace {

/// Patches of which a view shows something.
std::vector<PatchId> patchesInViews(const ShortfallSearch& search, const std::vector<std::size_t>& views) {
    std::vector<PatchId> patches;
    for (const auto& [where, count] : sightingCounts(search)) {
        const PatchId id = search.patch(where.first).id;
        if (std::find(views.begin(), views.end(), where.second) != views.end() &&
            (patches.empty() || patches.back() != id))
            patches.push_back(id);
    }
    return patches;
}

}  // namespace

void findUndecidedViews(ShortfallSearch& search) {
    const auto report = [&](const std::vector<std::size_t>& views, bool areUsed) {
        if (views.empty())
            return;
        Shortfall shortfall{Shortfall::Kind::UndecidedViews};
        for (const std::size_t v : views)
            shortfall.views.push_back(search.viewName(v));
        shortfall.patches = patchesInViews(search, views);
        const Sentence which =
            areUsed
                ? Sentence::saying("{} could be in two places, the likelier was taken", listedViews(shortfall.views))
            : views.size() == 1
                ? Sentence::saying("{} could be in two places and does not count", listedViews(shortfall.views))
                : Sentence::saying("{} could be in two places and do not count", listedViews(shortfall.views));
        shortfall.text =
            shortfall.patches.size() == 1
                ? Sentence::saying(
                      "{}: what is flat looks alike from two sides. Add a view that shows {} tilted by 40° and "
                      "more, or together with another patch",
                      which, listed(shortfall.patches))
                : Sentence::saying(
                      "{}: what is flat looks alike from two sides. Add a view that shows {} tilted by 40° and "
                      "more",
                      which, listed(shortfall.patches));
        search.found.push_back(std::move(shortfall));
    };
    report(search.solution.estimate.undecidedViews, true);
    // Enough of placed patches in the picture, and yet no place for the camera.
    std::vector<int> leds(search.solution.solved.T_r_v.size(), 0);
    for (const PixelObservation& o : search.solution.input.pixels)
        leds[o.view] += search.basis.isPlaced(o.module) ? 1 : 0;
    std::vector<std::size_t> unplaced;
    for (std::size_t v = 0; v < leds.size(); ++v) {
        if (!search.solution.solved.T_r_v[v] && leds[v] >= search.options.ledsOfAPose)
            unplaced.push_back(v);
    }
    report(unplaced, false);
}

}  // namespace skincal
