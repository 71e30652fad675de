#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "core/camera/camera_trouble.h"

namespace skincal {

/// An open Video4Linux node.
class V4l2Device {
  public:
    V4l2Device() = default;
    V4l2Device(const V4l2Device&) = delete;
    V4l2Device& operator=(const V4l2Device&) = delete;
    virtual ~V4l2Device() = default;

    /// As ioctl(2), never interrupted. @return 0, or the error number
    [[nodiscard]] virtual int ask(unsigned long request, void* argument) = 0;
};

/// The operating system's video nodes, so that tests can have their own.
class V4l2System {
  public:
    V4l2System() = default;
    V4l2System(const V4l2System&) = delete;
    V4l2System& operator=(const V4l2System&) = delete;
    virtual ~V4l2System() = default;

    /// Paths of all nodes, in the order of their numbers.
    [[nodiscard]] virtual std::vector<std::string> paths() const = 0;
    /// The error is that of open(2).
    [[nodiscard]] virtual tl::expected<std::unique_ptr<V4l2Device>, int> open(const std::string& path) const = 0;
};

/// /dev/video0 and so on; no node where there is no Video4Linux.
[[nodiscard]] const V4l2System& v4l2System();

/// A node that pictures come from, or that can't be opened to see whether they do.
struct V4l2Node {
    std::string path;
    std::string card;  ///< the name that multimedia libraries list it by
    int error = 0;     ///< why it can't be opened, as errno; 0 where it can
};

/// Nodes that give pictures, and those that can't be opened. A webcam has a second node for metadata: not among them.
[[nodiscard]] std::vector<V4l2Node> captureNodes(const V4l2System& system);

/// Why a camera that gave no pictures didn't: Forbidden, Busy or Unplugged; nothing where the node is fine. To be asked
/// while nobody in this program streams from it.
[[nodiscard]] std::optional<CameraTrouble> diagnose(const V4l2System& system, const std::string& path);

}  // namespace skincal
