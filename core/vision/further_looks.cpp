#include "core/vision/further_looks.h"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/geometry/random.h"
#include "core/vision/looks.h"

namespace skincal {
namespace {

std::set<ModuleId> missingIn(const ViewDetections& view) {
    std::set<ModuleId> missing;
    for (const Undetected& one : view.undetected) {
        // Another look shows two spots again.
        if (one.spots.empty())
            missing.insert(one.module);
    }
    return missing;
}

bool isMostlyOutOfSight(const ViewDetections& view) {
    const auto unseen = std::count_if(view.undetected.begin(), view.undetected.end(),
                                      [](const Undetected& one) { return one.cause == Undetected::Cause::OutOfSight; });
    return 2 * static_cast<std::size_t>(unseen) > view.undetected.size();
}

/// Some of those that were found, far apart: one, and each other is the farthest from those before it. Not always the
/// same: who is too close to one would never be told apart from it.
std::vector<ModuleId> anchorsIn(const ViewDetections& view, std::size_t most, std::size_t one) {
    std::vector<ModuleId> anchors;
    std::vector<double> nearest(view.found.size(), std::numeric_limits<double>::max());
    if (!nearest.empty())
        nearest[one % nearest.size()] = std::numeric_limits<double>::infinity();
    while (anchors.size() < std::min(most, view.found.size())) {
        const auto farthest =
            static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
        anchors.push_back(view.found[farthest].module);
        for (std::size_t i = 0; i < nearest.size(); ++i)
            nearest[i] = std::min(nearest[i], (view.found[i].pixel - view.found[farthest].pixel).norm());
    }
    return anchors;
}

/// A divisor of how many were lit together.
std::size_t partsFor(std::size_t found, std::size_t wanted) {
    return 2 * found >= wanted ? 1 : 4 * found >= wanted ? 2 : 4;
}

}  // namespace

FurtherLooks::FurtherLooks(std::uint64_t seed, const FurtherLookOptions& options) : seed_(seed), options_(options) {
    if (!options.validate())
        throw std::logic_error("FurtherLookOptions out of range");
}

void FurtherLooks::beginTurn(std::vector<ModuleId> modules) {
    inTurn_ = modules.size();
    foundInTurn_ = 0;
    if (modules.empty())
        return;
    atATime_ = std::clamp<std::size_t>(atATime_, 1, modules.size());
    // Neighbours have neighbouring numbers: whoever is looked for together must not be those again.
    Random random(seed_ + looks_, "looks");
    for (std::size_t i = modules.size(); i > 1; --i)
        std::swap(modules[i - 1], modules[random.index(i)]);
    const std::size_t parts = (modules.size() + atATime_ - 1) / atATime_;
    for (std::size_t part = 0; part < parts; ++part) {
        const auto at = [&](std::size_t k) {
            return modules.begin() + static_cast<std::ptrdiff_t>(k * modules.size() / parts);
        };
        waiting_.emplace_back(at(part), at(part + 1));
    }
}

std::optional<LitSets> FurtherLooks::next(const ViewDetections& view) {
    const std::set<ModuleId> missing = missingIn(view);
    // A knock spoils the pictures of all, however many they are.
    const bool isSpoilt = std::any_of(view.undetected.begin(), view.undetected.end(), [](const Undetected& one) {
        return one.cause == Undetected::Cause::CameraMoved;
    });
    const bool isOpen = isSpoilt || view.unexplained > 0;
    // What moved since goes on moving, or stands elsewhere: pixels of there don't belong to this view.
    if (!view.found.empty() && view.moved_px.value_or(0) > options_.maxMotion_px) {
        wanted_.clear();
        waiting_.clear();
        return std::nullopt;
    }
    // Nor would a look be believed that none that was found before can tell the place of.
    if (view.found.empty() && hasChoices(view))
        return std::nullopt;
    std::vector<ModuleId> wanted = std::exchange(wanted_, {});
    if (looks_ == 0) {
        const std::size_t all = missing.size() + view.found.size();
        atATime_ = isSpoilt ? all : all / partsFor(view.found.size(), all);
        if (isOpen)
            beginTurn({missing.begin(), missing.end()});
    }
    std::erase_if(wanted, [&](ModuleId module) { return !missing.contains(module); });
    foundInTurn_ += lastWanted_ - wanted.size();
    if (isOpen)
        left_.insert(left_.end(), wanted.begin(), wanted.end());
    // Where many are looked for in vain, and hardly any light of theirs is seen, it is the room that hides them, and
    // not each other's light.
    constexpr std::size_t kMany = 20;
    const bool isHopeless = foundInTurn_ == 0 && (atATime_ == 1 || (inTurn_ > kMany && isMostlyOutOfSight(view)));
    if (looks_ > 0 && waiting_.empty() && (isSpoilt || !isHopeless)) {
        atATime_ /= isSpoilt ? 1 : partsFor(foundInTurn_, inTurn_);
        beginTurn(std::exchange(left_, {}));
    }
    lastWanted_ = 0;
    if (waiting_.empty())
        return std::nullopt;
    std::vector<ModuleId> lit = anchorsIn(view, options_.anchors, 7 * looks_);
    lit.insert(lit.end(), waiting_.front().begin(), waiting_.front().end());
    ++looks_;
    LitSets look = codedScan(lit, seed_ + looks_);
    frames_ += look.size();
    if (frames_ > options_.maxFrames) {
        waiting_.clear();
        return std::nullopt;
    }
    wanted_ = std::move(waiting_.front());
    lastWanted_ = wanted_.size();
    waiting_.pop_front();
    return look;
}

}  // namespace skincal
