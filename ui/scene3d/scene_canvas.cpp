#include "ui/scene3d/scene_canvas.h"

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>

#include <QOpenGLFunctions>
#include <cmath>
#include <cstring>

namespace skincal {
namespace {

constexpr int kSamples = 4;

class SceneWindow : public vtkGenericOpenGLRenderWindow {
  public:
    vtkTypeMacro(SceneWindow, vtkGenericOpenGLRenderWindow) static SceneWindow* New();

    void setContext(QOpenGLContext* context, QSurface* surface) {
        context_ = context;
        surface_ = surface;
    }
    void MakeCurrent() override {
        if (!IsCurrent() && context_ != nullptr)
            context_->makeCurrent(surface_);
    }
    bool IsCurrent() override { return context_ != nullptr && QOpenGLContext::currentContext() == context_; }
    int IsDirect() override { return 1; }
    int SupportsOpenGL() override { return 1; }

    /// VTK's own goes by way of a third framebuffer and a shader, which costs a software renderer milliseconds.
    void Frame() override {
        const int* size = GetSize();
        GetRenderFramebuffer()->Bind(GL_READ_FRAMEBUFFER);
        GetRenderFramebuffer()->ActivateReadBuffer(0);
        GetDisplayFramebuffer()->Bind(GL_DRAW_FRAMEBUFFER);
        GetDisplayFramebuffer()->ActivateDrawBuffer(0);
        GetState()->vtkglDisable(GL_SCISSOR_TEST);
        GetState()->vtkglBlitFramebuffer(0, 0, size[0], size[1], 0, 0, size[0], size[1], GL_COLOR_BUFFER_BIT,
                                         GL_NEAREST);
    }

  private:
    QOpenGLContext* context_ = nullptr;
    QSurface* surface_ = nullptr;
};
vtkStandardNewMacro(SceneWindow)

}  // namespace

SceneCanvas::SceneCanvas() : renderer_(vtkSmartPointer<vtkRenderer>::New()) {
    QSurfaceFormat format;
    format.setRenderableType(QSurfaceFormat::OpenGL);
    format.setVersion(3, 2);
    format.setProfile(QSurfaceFormat::CoreProfile);
    surface_.setFormat(format);
    surface_.create();
    context_.setFormat(format);
    const auto window = vtkSmartPointer<SceneWindow>::New();
    window->SetOwnContext(0);
    window->SetReadyForRendering(false);
    window->AddRenderer(renderer_);
    window_ = window;
    if (!context_.create() || !context_.makeCurrent(&surface_))
        return;
    window->setContext(&context_, &surface_);
    window->SetReadyForRendering(true);
    window->InitializeFromCurrentContext();
    const auto* name = reinterpret_cast<const char*>(context_.functions()->glGetString(GL_RENDERER));
    const QByteArray drivenBy = QByteArray(name).toLower();
    isSoftware_ = drivenBy.contains("llvmpipe") || drivenBy.contains("softpipe") || drivenBy.contains("swrast");
}

SceneCanvas::~SceneCanvas() {
    if (!window_->GetReadyForRendering())
        return;
    window_->MakeCurrent();
    window_->Finalize();
    window_->SetReadyForRendering(false);
    static_cast<SceneWindow*>(window_.Get())->setContext(nullptr, nullptr);
}

vtkRenderer& SceneCanvas::renderer() const {
    return *renderer_;
}

vtkGenericOpenGLRenderWindow& SceneCanvas::window() const {
    return *window_;
}

const QImage& SceneCanvas::draw(const QSize& size, double ratio, bool smooth) {
    if (!window_->GetReadyForRendering() || size.isEmpty())
        return picture_;
    window_->SetSize(size.width(), size.height());
    window_->SetDPI(static_cast<int>(std::lround(72 * ratio)));
    window_->SetMultiSamples(smooth ? kSamples : 0);
    renderer_->ResetCameraClippingRange();
    window_->Render();
    if (picture_.size() != size) {
        upsideDown_ = QImage(size, QImage::Format_RGB32);
        picture_ = QImage(size, QImage::Format_RGB32);
    }
    picture_.setDevicePixelRatio(ratio);
    window_->GetDisplayFramebuffer()->Bind(GL_READ_FRAMEBUFFER);
    window_->GetDisplayFramebuffer()->ActivateReadBuffer(0);
    context_.functions()->glReadPixels(0, 0, size.width(), size.height(), GL_BGRA, GL_UNSIGNED_BYTE,
                                       upsideDown_.bits());
    const auto width = static_cast<std::size_t>(picture_.bytesPerLine());
    for (int y = 0; y < size.height(); ++y)
        std::memcpy(picture_.scanLine(y), upsideDown_.constScanLine(size.height() - 1 - y), width);
    return picture_;
}

}  // namespace skincal
