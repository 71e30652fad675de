#pragma once

#include <QObject>
#include <QThreadPool>
#include <memory>

#include "core/vision/live_spots.h"

namespace skincal {

/// LiveSpots in a thread of its own, for a picture that comes now and then.
class SpotWatcher : public QObject {
    Q_OBJECT
  public:
    explicit SpotWatcher(QObject* parent = nullptr);
    /// Waits for the picture that is being looked at: some hundredths of a second.
    ~SpotWatcher() override;

    /// Forgets what there was.
    void begin(std::vector<ModuleId> modules, LitSets lit);
    void add(const cv::Mat& picture);
    void clear();

    [[nodiscard]] const std::vector<LiveSpot>& spots() const { return spots_; }
    /// How many pictures have told of them.
    [[nodiscard]] std::size_t pictures() const { return pictures_; }

  signals:
    void changed();

  private:
    QThreadPool pool_;
    std::shared_ptr<LiveSpots> live_;  ///< touched by the pool's one thread only
    std::vector<LiveSpot> spots_;
    std::size_t pictures_ = 0;
};

}  // namespace skincal
