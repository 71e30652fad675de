#pragma once

#include <QObject>
#include <QThreadPool>
#include <memory>

#include "core/vision/live_motion.h"
#include "core/vision/live_spots.h"

namespace skincal {

/// LiveSpots and LiveMotion in a thread of its own, for a picture that comes now and then.
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
    /// By how much the camera has moved; empty while it stands.
    [[nodiscard]] std::optional<double> moved_px() const { return moved_px_; }
    /// How many pictures have told of them.
    [[nodiscard]] std::size_t pictures() const { return pictures_; }

  signals:
    void changed();

  private:
    QThreadPool pool_;
    std::shared_ptr<LiveSpots> live_;     ///< touched by the pool's one thread only
    std::shared_ptr<LiveMotion> motion_;  ///< likewise
    std::vector<LiveSpot> spots_;
    std::optional<double> moved_px_;
    std::size_t pictures_ = 0;
};

}  // namespace skincal
