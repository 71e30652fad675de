#include "core/rig/render_worker.h"

#include <limits>

#include "core/rig/board_painter.h"

namespace skincal {
namespace {

// Knocks half-way through a scan are not for a camera that runs on and on.
constexpr std::size_t kEndless = std::numeric_limits<std::size_t>::max();

}  // namespace

RenderWorker::RenderWorker(std::shared_ptr<const World> world, std::function<void()> done)
    : world_(std::move(world)), done_(std::move(done)), thread_([this](const std::stop_token& stop) { work(stop); }) {}

RenderWorker::~RenderWorker() = default;

void RenderWorker::draw(RenderRequest request) {
    {
        const std::lock_guard lock(mutex_);
        request_ = std::move(request);
    }
    wake_.notify_one();
}

std::optional<RenderedFrame> RenderWorker::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(picture_, std::nullopt);
}

void RenderWorker::work(const std::stop_token& stop) {
    std::optional<FrameRenderer> renderer;
    std::optional<BoardPainter> boards;
    Isometry3d T_r_v = Isometry3d::Identity();
    for (;;) {
        RenderRequest request;
        {
            std::unique_lock lock(mutex_);
            if (!wake_.wait(lock, stop, [this] { return request_.has_value(); }))
                return;
            if (stop.stop_requested())
                return;
            request = *std::exchange(request_, std::nullopt);
        }
        if (!renderer)
            renderer.emplace(*world_, request.T_r_v, 0, kEndless);
        else if (T_r_v.matrix() != request.T_r_v.matrix())
            renderer->moveCamera(request.T_r_v);
        T_r_v = request.T_r_v;
        RenderedFrame picture{std::move(request.caption), request.run};
        HeldLayer held;
        if (request.board) {
            if (!boards)
                boards.emplace(world_->scenario.camera, world_->scenario.pictures.blur_px);
            held = boards->paint(*request.board, request.T_v_b);
        }
        std::vector<cv::Mat> looks;
        std::vector<Shutter::Time> until;
        for (const LitUntil& span : request.lit) {
            looks.push_back(renderer->render(span.lit, request.frame, request.colour, request.exposure, held));
            until.push_back(span.until);
        }
        picture.frame.image = looks.size() == 1 ? looks.front() : exposeRows(looks, until, request.shutter);
        {
            const std::lock_guard lock(mutex_);
            picture_ = std::move(picture);
        }
        done_();
    }
}

}  // namespace skincal
