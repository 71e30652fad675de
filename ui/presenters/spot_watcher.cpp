#include "ui/presenters/spot_watcher.h"

#include <QtConcurrent/QtConcurrentRun>

namespace skincal {

SpotWatcher::SpotWatcher(QObject* parent) : QObject(parent) {
    pool_.setMaxThreadCount(1);  // in the order in which they were taken
}

SpotWatcher::~SpotWatcher() {
    pool_.clear();
    pool_.waitForDone();
}

void SpotWatcher::begin(std::vector<ModuleId> modules, LitSets lit) {
    clear();
    live_ = std::make_shared<LiveSpots>(std::move(modules), std::move(lit));
    motion_ = std::make_shared<LiveMotion>();
}

void SpotWatcher::clear() {
    pool_.clear();
    live_.reset();
    motion_.reset();
    moved_px_.reset();
    pictures_ = 0;
    if (!std::exchange(spots_, {}).empty())
        emit changed();
}

void SpotWatcher::add(const cv::Mat& picture) {
    if (!live_)
        return;
    QtConcurrent::run(&pool_, [live = live_, motion = motion_, picture] {
        live->add(picture);
        motion->add(picture);
        return std::make_tuple(live->pictures(), live->spots(), motion->moved_px());
    }).then(this, [this, live = live_](std::tuple<std::size_t, std::vector<LiveSpot>, std::optional<double>> seen) {
        if (live != live_)
            return;  // of a scan that is over
        std::tie(pictures_, spots_, moved_px_) = std::move(seen);
        emit changed();
    });
}

}  // namespace skincal
