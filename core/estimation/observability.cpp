#include "core/estimation/observability.h"

#include <algorithm>
#include <stdexcept>

#include "core/estimation/gravity_shortfall.h"
#include "core/estimation/one_sided_patches.h"
#include "core/estimation/patch_shortfall.h"
#include "core/estimation/view_forecast.h"

namespace skincal {
namespace {

void findFewViews(ShortfallSearch& search) {
    OneSidedPatches oneSided =
        oneSidedPatches(search.solution.layout, search.basis.used.pixels, search.basis.state, search.options.viewAngle);
    if (oneSided.patches.empty())
        return;
    Shortfall shortfall{Shortfall::Kind::FewViews};
    shortfall.patches = std::move(oneSided.patches);
    shortfall.figure = oneSided.widestAngle / kDegree;
    shortfall.unit = "deg";
    shortfall.text = std::move(oneSided.text);
    search.found.push_back(std::move(shortfall));
}

void reportModules(ShortfallSearch& search, Shortfall::Kind kind, const std::vector<std::size_t>& modules,
                   const std::optional<BodyPrecision>& precision, const Sentence& why) {
    if (modules.empty())
        return;
    Shortfall shortfall{kind};
    double sigma = 0;
    for (const std::size_t u : modules) {
        shortfall.modules.push_back(search.id(u));
        sigma = std::max(sigma, precision ? precision->sigma(u) : 0);
    }
    const bool one = modules.size() == 1;
    Sentence how = one ? Sentence::saying("{} is placed by gravity and links alone", listed(shortfall.modules))
                       : Sentence::saying("{} are placed by gravity and links alone", listed(shortfall.modules));
    if (precision) {
        shortfall.figure = sigma * 1e3;
        shortfall.unit = "mm";
        how = one ? Sentence::saying("{} (±{:.2f} mm)", how, *shortfall.figure)
                  : Sentence::saying("{} (up to ±{:.2f} mm)", how, *shortfall.figure);
    }
    shortfall.text = Sentence::saying("{}, for {}", how, why);
    search.found.push_back(std::move(shortfall));
}

void findDarkModules(ShortfallSearch& search, const std::optional<BodyPrecision>& precision) {
    const UnseenModules dark = unseenModules(search.basis, {});
    reportModules(search, Shortfall::Kind::ModulesUnseen, dark.unseen, precision,
                  dark.unseen.size() == 1 ? Sentence::saying("no view looks at it: add one that does")
                                          : Sentence::saying("no view looks at them: add one that does"));
    reportModules(
        search, Shortfall::Kind::ModulesHidden, dark.hidden, precision,
        dark.hidden.size() == 1
            ? Sentence::saying("the views that look at it do not show it: it is covered, or its LED is broken")
            : Sentence::saying(
                  "the views that look at them do not show them: they are covered, or their LEDs are broken"));
}

/// The two modules that are the farthest apart, roughly: the farthest from the first, and the farthest from that.
std::pair<std::size_t, std::size_t> farApart(const BodyState& state, std::size_t first) {
    const auto farthest = [&](std::size_t from) {
        std::size_t best = from;
        double distance = 0;
        for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
            const double d =
                state.T_r_u[u] ? (state.T_r_u[u]->translation() - state.T_r_u[from]->translation()).norm() : 0;
            if (d > distance) {
                distance = d;
                best = u;
            }
        }
        return best;
    };
    const std::size_t a = farthest(first);
    return {a, farthest(a)};
}

void findPoorScale(ShortfallSearch& search, const BodyPrecision& precision) {
    const auto& links = search.basis.used.links;
    const bool linked = std::any_of(links.begin(), links.end(), [&](const PortPair& link) {
        return search.basis.isPlaced(link.a) && search.basis.isPlaced(link.b);
    });
    const auto first = precision.worst();
    if (!first || (linked && precision.scale <= search.options.relativeScale))
        return;
    const auto [a, b] = farApart(search.basis.state, *first);
    if (a == b)
        return;
    const auto led = [&](std::size_t u) -> Vector3d {
        return *search.basis.state.T_r_u[u] * search.skin().templateOf(u).led;
    };
    const double distance = (led(a) - led(b)).norm();
    Shortfall shortfall{Shortfall::Kind::ScaleFromLinksOnly};
    shortfall.modules = {search.id(a), search.id(b)};
    shortfall.figure = precision.scale * 100;
    shortfall.unit = "%";
    shortfall.text = Sentence::saying(
        "{}, so that the size of the body is known to {:.1f} % only: measure the distance between the LEDs of modules "
        "{} and {}, here {:.1f} ± {:.1f} mm, or add modules that are linked port to port",
        linked ? Sentence::saying("few links tell how large the body is")
               : Sentence::saying("no link joins placed modules, their LEDs' offsets alone tell how large the body is"),
        precision.scale * 100, search.id(a).value, search.id(b).value, distance * 1e3,
        distance * precision.scale * 1e3);
    search.found.push_back(std::move(shortfall));
}

}  // namespace

std::string_view name(Shortfall::Kind kind) {
    switch (kind) {
        case Shortfall::Kind::GravityMissing:
            return "gravity-missing";
        case Shortfall::Kind::PosesAlike:
            return "poses-alike";
        case Shortfall::Kind::PatchUnseen:
            return "patch-unseen";
        case Shortfall::Kind::PatchSeenTooLittle:
            return "patch-seen-too-little";
        case Shortfall::Kind::PatchNeverWithPlaced:
            return "patch-never-with-placed";
        case Shortfall::Kind::PatchContradicted:
            return "patch-contradicted";
        case Shortfall::Kind::UndecidedViews:
            return "undecided-views";
        case Shortfall::Kind::FewViews:
            return "few-views";
        case Shortfall::Kind::ModulesHidden:
            return "modules-hidden";
        case Shortfall::Kind::ModulesUnseen:
            return "modules-unseen";
        case Shortfall::Kind::ScaleFromLinksOnly:
            return "scale-from-links-only";
        default:
            return "undetermined";
    }
}

std::vector<Shortfall> findShortfalls(const BodySolution& solution, const ShortfallOptions& options) {
    if (!options.validate())
        throw std::logic_error("ShortfallOptions out of range");
    ShortfallSearch search{solution, options, adviceBasis(solution)};
    search.found = gravityShortfalls(solution, search.basis, options);
    findUnplacedPatches(search);
    findUndecidedViews(search);
    findFewViews(search);
    std::optional<BodyPrecision> precision;
    if (search.basis.placedModules() > 0) {
        auto computed = bodyPrecision(search.basis.used, search.basis.state, solution.gauge, solution.weights);
        if (computed)
            precision = std::move(*computed);
        else
            search.found.push_back(
                {Shortfall::Kind::Undetermined,
                 {},
                 {},
                 {},
                 {},
                 {},
                 {},
                 Sentence::saying("the measurements do not fix where everything is, so that nothing can be said of "
                                  "how exact the result is: add gravity poses and views")});
    }
    findDarkModules(search, precision);
    if (precision)
        findPoorScale(search, *precision);
    std::stable_sort(search.found.begin(), search.found.end(),
                     [](const Shortfall& a, const Shortfall& b) { return a.kind < b.kind; });
    return std::move(search.found);
}

}  // namespace skincal
