#include "core/camera/camera_list.h"

#include <QCameraDevice>
#include <QMediaDevices>
#include <algorithm>
#include <cerrno>

namespace skincal {
namespace {

ListedCamera listed(const QCameraDevice& device) {
    ListedCamera camera;
    camera.id = device.id().toStdString();
    camera.description = device.description().toStdString();
    for (const QCameraFormat& format : device.videoFormats())
        camera.formats.push_back(
            {format.resolution().width(), format.resolution().height(), static_cast<double>(format.maxFrameRate())});
    camera.formats = withoutDoubles(std::move(camera.formats));
    return camera;
}

bool isSame(const V4l2Node& a, const V4l2Node& b) {
    return a.path == b.path && a.card == b.card && a.error == b.error;
}

}  // namespace

void prepareMultimedia() {
    constexpr auto kVariable = "GST_PLUGIN_FEATURE_RANK";
    QByteArray ranks = qgetenv(kVariable);
    if (ranks.contains("pipewiredeviceprovider"))
        return;
    if (!ranks.isEmpty())
        ranks += ',';
    qputenv(kVariable, ranks + "pipewiredeviceprovider:NONE");
}

CameraList::CameraList(const V4l2System& system, QObject* parent) : QObject(parent), system_(system) {
    prepareMultimedia();
    devices_ = std::make_unique<QMediaDevices>();
    // Queued: asking for the list within the signal locks up where it was never asked for before.
    connect(devices_.get(), &QMediaDevices::videoInputsChanged, this, &CameraList::refresh, Qt::QueuedConnection);
    refresh();
}

CameraList::~CameraList() = default;

std::vector<std::string> CameraList::forbidden() const {
    std::vector<std::string> paths;
    for (const V4l2Node& node : nodes_) {
        if (node.error == EACCES || node.error == EPERM)
            paths.push_back(node.path);
    }
    return paths;
}

QCameraDevice CameraList::deviceOf(const ListedCamera& camera) {
    for (const QCameraDevice& device : QMediaDevices::videoInputs()) {
        if (device.id().toStdString() == camera.id && device.description().toStdString() == camera.description)
            return device;
    }
    return {};
}

void CameraList::refresh() {
    std::vector<ListedCamera> cameras;
    for (const QCameraDevice& device : QMediaDevices::videoInputs())
        cameras.push_back(listed(device));
    std::vector<V4l2Node> nodes = captureNodes(system_);
    cameras = withoutDoubles(std::move(cameras), nodes);
    const bool isOther =
        cameras != cameras_ || !std::equal(nodes.begin(), nodes.end(), nodes_.begin(), nodes_.end(), isSame);
    cameras_ = std::move(cameras);
    nodes_ = std::move(nodes);
    if (isOther)
        emit changed();
}

}  // namespace skincal
