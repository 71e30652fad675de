#pragma once

#include <QObject>
#include <QTimer>
#include <optional>
#include <string>
#include <vector>

#include "ui/presenters/picture_series.h"
#include "ui/presenters/scan_presenter.h"
#include "ui/presenters/spot_watcher.h"
#include "ui/presenters/views_presenter.h"

namespace skincal {

/// A patch, as far as the camera sees it from where it stands now.
struct PatchInSight {
    PatchId patch;
    std::size_t modules = 0;
    std::size_t seen = 0;  ///< spots that blink with it, at most `modules`
    bool isPlaced = false;

    /// Whether a scan from here would tell where it is.
    [[nodiscard]] bool isEnough() const;
};

struct SpotInSight {
    Vector2d pixel = Vector2d::Zero();
    std::size_t patch = 0;  ///< position in patches()
};

/// Tells, before a view is scanned, whether it would do: lights one patch after the other, again and again, and counts
/// the spots. Leaves the LEDs alone while a scan has them.
class ViewPreview : public QObject {
    Q_OBJECT
  public:
    enum class Verdict {
        Unknown,      ///< not looked yet, or it can't be
        Moving,       ///< spots do not stay where they are
        Nothing,      ///< no patch well enough in the picture
        Unconnected,  ///< patches that are not placed, and none that is
        NothingNew,   ///< placed ones only, while others are missing
        SamePlace,    ///< a view was scanned from here
        Good,
    };

    ViewPreview(Workbench& workbench, ScanPresenter& scan, const ViewsPresenter& views, QObject* parent = nullptr);

    /// Looks while a page shows what it finds.
    void setActive(bool active);

    [[nodiscard]] Verdict verdict() const { return verdict_; }
    /// The verdict with its reason, in a sentence; empty where it is not known.
    [[nodiscard]] QString words() const;
    [[nodiscard]] const std::vector<PatchInSight>& patches() const { return patches_; }
    [[nodiscard]] const std::vector<SpotInSight>& spots() const { return spots_; }

  signals:
    void changed();

  private:
    void look();
    void judge();
    /// That of all that was scanned whose picture is this one; nothing where the camera stands elsewhere.
    [[nodiscard]] std::optional<std::string> viewFromHere() const;
    void forget();

    Workbench& workbench_;
    ScanPresenter& scan_;
    const ViewsPresenter& views_;
    PictureSeries series_;
    SpotWatcher watcher_;
    QTimer again_;
    std::vector<PatchInSight> asked_;  ///< those that are being looked for
    std::vector<PatchInSight> patches_;
    std::vector<SpotInSight> spots_;
    Verdict verdict_ = Verdict::Unknown;
    std::string sameAs_;  ///< the view, in Verdict::SamePlace
    bool isActive_ = false;
};

}  // namespace skincal
