#include "ui/window/camera_offers.h"

#include <algorithm>

#include "core/camera/webcam_source.h"

namespace skincal {
namespace {

using CameraOffer = Offer<FrameSource>;

constexpr auto kWebcam = "webcam:";
constexpr auto kVideo = "video:";

QString keyOf(const ListedCamera& camera) {
    return QLatin1String(kWebcam) + QString::fromStdString(camera.description) + QLatin1Char('#') +
           QString::number(camera.ordinal);
}

/// A camera that is there and may not be opened: all it does is to say so.
class ForbiddenCamera : public FrameSource {
  public:
    explicit ForbiddenCamera(QString node) : node_(std::move(node)) {}

    [[nodiscard]] QString name() const override { return node_; }
    [[nodiscard]] std::vector<FrameFormat> formats() const override { return {}; }
    [[nodiscard]] FrameFormat format() const override { return {}; }
    void setFormat(const FrameFormat&) override {}
    [[nodiscard]] std::optional<std::pair<double, double>> exposureRange() const override { return std::nullopt; }
    [[nodiscard]] std::optional<double> exposure() const override { return std::nullopt; }
    void setExposure(double) override {}
    [[nodiscard]] std::optional<CameraFailure> failure() const override {
        return CameraFailure{CameraTrouble::Forbidden, node_};
    }
    void start() override {
        QMetaObject::invokeMethod(
            this, [this] { emit failed(shortReason(*failure())); }, Qt::QueuedConnection);
    }
    void stop() override {}

  private:
    QString node_;
};

}  // namespace

CameraOffers::CameraOffers(Workbench& workbench, std::shared_ptr<CameraList> list, QObject* parent)
    : QObject(parent), workbench_(workbench), list_(std::move(list)) {
    connect(list_.get(), &CameraList::changed, this, &CameraOffers::refresh);
    refresh();
}

void CameraOffers::refresh() {
    std::vector<CameraOffer> offers;
    std::vector<CameraOffer> videos;
    std::optional<CameraOffer> chosen;
    for (std::size_t k = 0; k < workbench_.cameraOffers.size(); ++k) {
        const CameraOffer& offer = workbench_.cameraOffers[k];
        if (offer.key.startsWith(QLatin1String(kVideo)))
            videos.push_back(offer);
        else if (!offer.key.startsWith(QLatin1String(kWebcam)))
            offers.push_back(offer);
        else if (static_cast<int>(k) == workbench_.chosenCamera())
            chosen = offer;
    }
    for (const ListedCamera& camera : list_->cameras()) {
        QString name = QString::fromStdString(camera.description);
        if (camera.ordinal > 0)
            name += QStringLiteral(" (%1)").arg(camera.ordinal + 1);
        const QString where = QString::fromStdString(camera.node);
        offers.push_back({name, where.isEmpty() ? tr("A webcam") : tr("The webcam at %1").arg(where),
                          [list = list_, camera] { return std::make_unique<WebcamSource>(list, camera); },
                          keyOf(camera)});
    }
    for (const std::string& node : list_->forbidden()) {
        const QString path = QString::fromStdString(node);
        offers.push_back({tr("%1 (not allowed)").arg(path), tr("A camera that you are not allowed to open"),
                          [path] { return std::make_unique<ForbiddenCamera>(path); }, QLatin1String(kWebcam) + path});
    }
    const auto isChosen = [&](const CameraOffer& offer) { return chosen && offer.key == chosen->key; };
    if (chosen && std::none_of(offers.begin(), offers.end(), isChosen)) {
        const QString gone = tr(" (not plugged in)");
        if (!chosen->name.endsWith(gone))
            chosen->name += gone;
        offers.push_back(*chosen);
    }
    std::move(videos.begin(), videos.end(), std::back_inserter(offers));
    workbench_.setCameraOffers(std::move(offers));
}

}  // namespace skincal
