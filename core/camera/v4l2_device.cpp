#include "core/camera/v4l2_device.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>

#ifdef __linux__
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>
#endif

namespace skincal {
namespace {

#ifdef __linux__

class OpenNode : public V4l2Device {
  public:
    explicit OpenNode(int file) : file_(file) {}
    OpenNode(const OpenNode&) = delete;
    OpenNode& operator=(const OpenNode&) = delete;
    ~OpenNode() override { ::close(file_); }

    int ask(unsigned long request, void* argument) override {
        int result = 0;
        do
            result = ::ioctl(file_, request, argument);
        while (result < 0 && errno == EINTR);
        return result < 0 ? errno : 0;
    }

  private:
    int file_;
};

class Nodes : public V4l2System {
  public:
    [[nodiscard]] std::vector<std::string> paths() const override {
        std::vector<std::pair<int, std::string>> found;
        std::error_code error;
        for (const auto& entry : std::filesystem::directory_iterator("/dev", error)) {
            const std::string name = entry.path().filename().string();
            int number = 0;
            if (name.starts_with("video") &&
                std::from_chars(name.data() + 5, name.data() + name.size(), number).ptr == name.data() + name.size())
                found.emplace_back(number, entry.path().string());
        }
        std::sort(found.begin(), found.end());
        std::vector<std::string> paths;
        for (auto& [number, path] : found)
            paths.push_back(std::move(path));
        return paths;
    }

    [[nodiscard]] tl::expected<std::unique_ptr<V4l2Device>, int> open(const std::string& path) const override {
        // Without waiting: some drivers block until a signal is there.
        const int file = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
        if (file < 0)
            return tl::unexpected(errno);
        return std::make_unique<OpenNode>(file);
    }
};

bool givesPictures(V4l2Device& device, std::string& card) {
    v4l2_capability capability{};
    if (device.ask(VIDIOC_QUERYCAP, &capability) != 0)
        return false;
    const char* name = reinterpret_cast<const char*>(capability.card);
    card.assign(name, std::find(name, name + sizeof(capability.card), '\0'));
    const std::uint32_t can =
        (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0U ? capability.device_caps : capability.capabilities;
    return (can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0U;
}

/// A format can't be set while somebody streams.
int setFormatAgain(V4l2Device& device) {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    const int error = device.ask(VIDIOC_G_FMT, &format);
    return error != 0 ? error : device.ask(VIDIOC_S_FMT, &format);
}

#else

class Nodes : public V4l2System {
  public:
    [[nodiscard]] std::vector<std::string> paths() const override { return {}; }
    [[nodiscard]] tl::expected<std::unique_ptr<V4l2Device>, int> open(const std::string&) const override {
        return tl::unexpected(ENOENT);
    }
};

bool givesPictures(V4l2Device&, std::string&) {
    return false;
}

int setFormatAgain(V4l2Device&) {
    return 0;
}

#endif

std::optional<CameraTrouble> troubleOf(int error) {
    switch (error) {
        case EACCES:
        case EPERM:
            return CameraTrouble::Forbidden;
        case EBUSY:
            return CameraTrouble::Busy;
        case ENOENT:
        case ENODEV:
        case ENXIO:
            return CameraTrouble::Unplugged;
        default:
            return std::nullopt;
    }
}

}  // namespace

const V4l2System& v4l2System() {
    static const Nodes nodes;
    return nodes;
}

std::vector<V4l2Node> captureNodes(const V4l2System& system) {
    std::vector<V4l2Node> nodes;
    for (const std::string& path : system.paths()) {
        const auto device = system.open(path);
        V4l2Node node{path, {}, device ? 0 : device.error()};
        if (!device || givesPictures(**device, node.card))
            nodes.push_back(std::move(node));
    }
    return nodes;
}

std::optional<CameraTrouble> diagnose(const V4l2System& system, const std::string& path) {
    const auto device = system.open(path);
    return troubleOf(device ? setFormatAgain(**device) : device.error());
}

}  // namespace skincal
