#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "core/camera/frame_source.h"
#include "core/camera_calibration/board_plan.h"
#include "core/rig/shutter.h"
#include "core/simulation/renderer.h"

namespace skincal {

/// A picture to draw, and what to call it.
struct RenderRequest {
    Isometry3d T_r_v = Isometry3d::Identity();
    std::vector<LitUntil> lit;  ///< while it is exposed, one at least
    Shutter shutter;
    std::size_t frame = 0;  ///< of the disturbances, see FrameRenderer
    bool colour = false;
    double exposure = 1;             ///< see FrameRenderer::render
    std::optional<BoardPlan> board;  ///< that is held before the camera
    std::vector<Isometry3d> T_v_b;   ///< of it, see BoardPainter::paint
    std::uint64_t run = 0;
    CameraFrame caption;  ///< time and sequence
};

struct RenderedFrame {
    CameraFrame frame;
    std::uint64_t run = 0;
};

/// Draws pictures on a thread of its own. One request waits at most, a newer one replaces it; the same with pictures.
class RenderWorker {
  public:
    /// @param done  called on the worker's thread once there is a picture to take
    RenderWorker(std::shared_ptr<const World> world, std::function<void()> done);
    /// Waits for the picture that is being drawn, not for the one that waits.
    ~RenderWorker();
    RenderWorker(const RenderWorker&) = delete;
    RenderWorker& operator=(const RenderWorker&) = delete;

    void draw(RenderRequest request);
    /// Nothing where it has been taken already.
    [[nodiscard]] std::optional<RenderedFrame> take();

  private:
    void work(const std::stop_token& stop);

    std::shared_ptr<const World> world_;
    std::function<void()> done_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::optional<RenderRequest> request_;
    std::optional<RenderedFrame> picture_;
    std::jthread thread_;  // last: the rest must be there before it runs and until it has ended
};

}  // namespace skincal
