#include "ui/presenters/view_preview.h"

#include <algorithm>

namespace skincal {
namespace {

using namespace std::chrono_literals;

constexpr auto kPause = 300ms;  // between two looks
constexpr auto kPatience = 3s;
constexpr std::size_t kEnough = 4;    // LEDs that give a pose
constexpr std::size_t kOneByOne = 8;  // patches; more are told apart by words

/// Stands for the k-th patch where LiveSpots wants a module.
ModuleId senderOf(std::size_t patch) {
    return ModuleId(static_cast<std::uint32_t>(patch) + 1);
}

/// Which patches to light, picture by picture.
LitSets lookAt(const std::vector<ModuleId>& senders) {
    if (senders.size() > kOneByOne)
        return codedScan(senders, 0);
    LitSets sets(2);
    for (const ModuleId sender : senders) {
        sets[1].push_back({sender, {}});
        sets.push_back({{sender, {}}});
    }
    // Where there is one patch only, what shines all the time would look like it.
    sets.emplace_back();
    return sets;
}

/// "patch 3", "patches 1, 2 and 3"; empty where there is none.
QString listed(const std::vector<PatchInSight>& patches, bool isPlaced) {
    QStringList names;
    for (const PatchInSight& patch : patches) {
        if (patch.isEnough() && patch.isPlaced == isPlaced)
            names << QString::number(patch.patch.value);
    }
    if (names.size() < 2)
        return names.isEmpty() ? QString() : ViewPreview::tr("patch %1").arg(names.front());
    const QString last = names.takeLast();
    return ViewPreview::tr("patches %1 and %2").arg(names.join(QStringLiteral(", ")), last);
}

}  // namespace

bool PatchInSight::isEnough() const {
    return seen >= kEnough;
}

ViewPreview::ViewPreview(Workbench& workbench, ScanPresenter& scan, const ViewsPresenter& views, QObject* parent)
    : QObject(parent), workbench_(workbench), scan_(scan), views_(views), series_(workbench) {
    again_.setSingleShot(true);
    connect(&again_, &QTimer::timeout, this, &ViewPreview::look);
    connect(&workbench, &Workbench::scanningChanged, this, [this](bool scanning) {
        if (scanning)
            series_.cancel();
        else if (isActive_)
            again_.start(kPause);
    });
    connect(&workbench, &Workbench::lightsClaimed, this, [this] {
        series_.cancel();
        if (isActive_)
            again_.start(kPatience);
    });
    connect(&series_, &PictureSeries::kept, this,
            [this](std::size_t frame) { watcher_.add(series_.pictureOf(frame)); });
    connect(&series_, &PictureSeries::complete, this, [this] {
        series_.finish();
        // Should the spots never come: a camera that changed its format meanwhile gives pictures that don't fit.
        if (isActive_)
            again_.start(kPatience);
    });
    connect(&series_, &PictureSeries::stateChanged, this, [this] {
        const bool isOver = series_.state().phase == ScanRun::Phase::Failed;
        if (isOver)
            forget();
        if (isActive_ && isOver)
            again_.start(1s);
    });
    connect(&watcher_, &SpotWatcher::changed, this, [this] {
        if (!isActive_ || watcher_.pictures() < series_.lit().size())
            return;
        judge();
        again_.start(kPause);
    });
}

void ViewPreview::setActive(bool active) {
    if (std::exchange(isActive_, active) == active)
        return;
    if (active) {
        look();
        return;
    }
    again_.stop();
    series_.cancel();
    forget();
}

void ViewPreview::look() {
    const auto& solution = workbench_.session().solution();
    if (!isActive_)
        return;
    if (!solution || workbench_.isScanning() || !scan_.obstacle().isEmpty()) {
        forget();
        again_.start(kPause);
        return;
    }
    asked_.clear();
    std::vector<ModuleId> senders;
    std::vector<std::vector<LitModule>> modulesOf;
    for (const BodyPatch& patch : solution->body.patches) {
        senders.push_back(senderOf(senders.size()));
        auto& lit = modulesOf.emplace_back();
        for (const ModuleId module : patch.modules)
            lit.push_back({module, {}});
        asked_.push_back({patch.id, patch.modules.size()});
    }
    const LitSets sets = lookAt(senders);
    LitSets lit;
    for (const auto& set : sets) {
        auto& modules = lit.emplace_back();
        for (const LitModule& sender : set) {
            const auto& own = modulesOf[sender.module.value - 1];
            modules.insert(modules.end(), own.begin(), own.end());
        }
    }
    watcher_.begin(std::move(senders), sets);
    series_.start(std::move(lit));
}

void ViewPreview::judge() {
    patches_ = asked_;
    spots_.clear();
    std::size_t strays = 0;
    for (const LiveSpot& spot : watcher_.spots()) {
        if (!spot.module) {
            ++strays;
            continue;
        }
        const std::size_t patch = spot.module->value - 1;
        spots_.push_back({spot.pixel, patch});
        patches_[patch].seen = std::min(patches_[patch].seen + 1, patches_[patch].modules);
    }
    bool isMissing = false;
    for (PatchInSight& patch : patches_) {
        for (const PatchState& state : views_.patches())
            patch.isPlaced = patch.isPlaced || (state.patch == patch.patch && state.isPlaced);
        isMissing = isMissing || (!patch.isPlaced && patch.modules >= kEnough);
    }
    const bool hasViews = std::any_of(views_.views().begin(), views_.views().end(),
                                      [](const ViewState& view) { return !view.isDropped; });
    const bool seesPlaced = !listed(patches_, true).isEmpty();
    const bool seesNew = !listed(patches_, false).isEmpty();
    if (strays > kEnough && strays > spots_.size())
        verdict_ = Verdict::Moving;
    else if (!seesPlaced && !seesNew)
        verdict_ = Verdict::Nothing;
    else if (hasViews && !seesPlaced)
        verdict_ = Verdict::Unconnected;
    else if (isMissing && !seesNew)
        verdict_ = Verdict::NothingNew;
    else if (const auto view = viewFromHere()) {
        verdict_ = Verdict::SamePlace;
        sameAs_ = *view;
    } else
        verdict_ = Verdict::Good;
    emit changed();
}

std::optional<std::string> ViewPreview::viewFromHere() const {
    constexpr double kSame_px = 4;
    const Session& session = workbench_.session();
    for (const ScannedView& view : session.measured().views) {
        if (session.decisions().droppedViews.contains(view.name))
            continue;
        const auto isThere = [&](const SpotInSight& spot) {
            return std::any_of(view.decoded.found.begin(), view.decoded.found.end(),
                               [&](const LedDetection& led) { return (led.pixel - spot.pixel).norm() < kSame_px; });
        };
        const auto there = std::count_if(spots_.begin(), spots_.end(), isThere);
        if (4 * there > 3 * static_cast<std::ptrdiff_t>(spots_.size()))
            return view.name;
    }
    return std::nullopt;
}

void ViewPreview::forget() {
    patches_.clear();
    spots_.clear();
    if (std::exchange(verdict_, Verdict::Unknown) != Verdict::Unknown)
        emit changed();
}

QString ViewPreview::words() const {
    const QString placed = listed(patches_, true);
    const QString fresh = listed(patches_, false);
    switch (verdict_) {
        case Verdict::Unknown:
            return {};
        case Verdict::Moving:
            return tr("Hold the camera still for a moment.");
        case Verdict::Nothing:
            return tr("From here no patch is well in the picture: go nearer, or look at the side with the LEDs.");
        case Verdict::Unconnected:
            return tr("Here, in the picture: %1, and none that is placed. Go on until both are.").arg(fresh);
        case Verdict::NothingNew:
            return tr("Here, in the picture: %1, placed already. That becomes more exact, but nothing is joined.")
                .arg(placed);
        case Verdict::SamePlace:
            return tr("%1 was taken from here: from another place a view tells more.")
                .arg(QString::fromStdString(sameAs_));
        case Verdict::Good:
            if (fresh.isEmpty())
                return tr("Good. In the picture: %1.").arg(placed);
            return placed.isEmpty() ? tr("Good. In the picture: %1.").arg(fresh)
                                    : tr("Good. In the picture: %1, to be joined to %2.").arg(fresh, placed);
    }
    return {};
}

}  // namespace skincal
