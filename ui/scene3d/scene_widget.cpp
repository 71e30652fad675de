#include "ui/scene3d/scene_widget.h"

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkGenericRenderWindowInteractor.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>

#include <QCoreApplication>
#include <QMouseEvent>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

namespace skincal {
namespace {

constexpr int kFrame_ms = 33;
constexpr int kRest_ms = 250;
constexpr int kSamples = 4;
constexpr qint64 kSlow_ms = 40;
constexpr double kClickRadius_px = 4;
constexpr double kRadian_deg = 57.29577951308232;

}  // namespace

QSurfaceFormat SceneWidget::sceneFormat() {
    QSurfaceFormat format;
    format.setRenderableType(QSurfaceFormat::OpenGL);
    format.setVersion(3, 2);
    format.setProfile(QSurfaceFormat::CoreProfile);
    format.setDepthBufferSize(24);
    format.setSamples(0);  // smoothing happens in VTK's own framebuffer
    return format;
}

SceneWidget::SceneWidget(QWidget* parent)
    : QOpenGLWidget(parent),
      window_(vtkSmartPointer<vtkGenericOpenGLRenderWindow>::New()),
      interactor_(vtkSmartPointer<vtkGenericRenderWindowInteractor>::New()),
      renderer_(vtkSmartPointer<vtkRenderer>::New()) {
    window_->SetOwnContext(0);
    window_->SetReadyForRendering(false);
    window_->SetFrameBlitModeToNoBlit();
    window_->SetMultiSamples(kSamples);
    window_->AddRenderer(renderer_);
    window_->AddObserver(vtkCommand::WindowMakeCurrentEvent, this, &SceneWidget::makeCurrentForVtk);
    window_->AddObserver(vtkCommand::WindowIsCurrentEvent, this, &SceneWidget::answerIsCurrent);
    window_->AddObserver(vtkCommand::WindowIsDirectEvent, this, &SceneWidget::answerYes);
    window_->AddObserver(vtkCommand::WindowSupportsOpenGLEvent, this, &SceneWidget::answerYes);
    window_->AddObserver(vtkCommand::WindowFrameEvent, this, &SceneWidget::drawLater);

    const auto style = vtkSmartPointer<vtkInteractorStyleTrackballCamera>::New();
    style->SetMotionFactor(8);
    interactor_->SetInteractorStyle(style);
    interactor_->SetRenderWindow(window_);
    // The style asks for a frame at every move; frames come at their own pace.
    interactor_->EnableRenderOff();
    interactor_->AddObserver(vtkCommand::RenderEvent, this, &SceneWidget::drawLater);
    interactor_->Initialize();

    drawTimer_.setSingleShot(true);
    connect(&drawTimer_, &QTimer::timeout, this, &SceneWidget::drawNow);
    restTimer_.setSingleShot(true);
    connect(&restTimer_, &QTimer::timeout, this, [this] {
        if (slow_)
            requestDraw();
    });
}

SceneWidget::~SceneWidget() {
    // QOpenGLWidget's destructor tells that the context goes when our members are gone already.
    disconnect(contextGoes_);
    releaseGraphics();
    interactor_->SetRenderWindow(nullptr);
    window_->SetInteractor(nullptr);
    window_->RemoveAllObservers();
    interactor_->RemoveAllObservers();
}

vtkRenderer& SceneWidget::renderer() const {
    return *renderer_;
}

void SceneWidget::makeCurrentForVtk(vtkObject* /*caller*/, unsigned long /*event*/, void* /*data*/) {
    // Making the context current again would bind Qt's framebuffer in the middle of VTK's frame.
    if (context() != nullptr && QOpenGLContext::currentContext() != context())
        makeCurrent();
}

void SceneWidget::answerIsCurrent(vtkObject* /*caller*/, unsigned long /*event*/, void* answer) {
    *static_cast<bool*>(answer) = context() != nullptr && QOpenGLContext::currentContext() == context();
}

void SceneWidget::answerYes(vtkObject* /*caller*/, unsigned long /*event*/, void* answer) {
    *static_cast<int*>(answer) = 1;
}

void SceneWidget::drawLater(vtkObject* /*caller*/, unsigned long /*event*/, void* /*data*/) {
    // VTK announces the end of the frame that we draw, too.
    if (!painting_)
        requestDraw();
}

void SceneWidget::requestDraw() {
    if (drawTimer_.isActive())
        return;
    const qint64 since = sinceFrame_.isValid() ? sinceFrame_.elapsed() : kFrame_ms;
    drawTimer_.start(static_cast<int>(std::clamp<qint64>(kFrame_ms - since, 0, kFrame_ms)));
}

void SceneWidget::animate() {
    restTimer_.start(kRest_ms);
    requestDraw();
}

void SceneWidget::drawNow() {
    sinceFrame_.start();
    emit aboutToDraw();
    update();
}

void SceneWidget::initializeGL() {
    contextGoes_ = connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, &SceneWidget::releaseGraphics);
    window_->SetReadyForRendering(true);
    window_->InitializeFromCurrentContext();
}

void SceneWidget::releaseGraphics() {
    if (context() == nullptr || !window_->GetReadyForRendering())
        return;
    makeCurrent();
    window_->Finalize();
    window_->SetReadyForRendering(false);
    doneCurrent();
}

void SceneWidget::takeSize() {
    // At every frame: another screen brings another ratio without a resize.
    const double ratio = devicePixelRatioF();
    const int w = std::max(1, static_cast<int>(std::lround(width() * ratio)));
    const int h = std::max(1, static_cast<int>(std::lround(height() * ratio)));
    window_->SetSize(w, h);
    window_->SetDPI(static_cast<int>(std::lround(72 * ratio)));
    interactor_->UpdateSize(w, h);
}

void SceneWidget::paintGL() {
    QElapsedTimer timer;
    timer.start();
    painting_ = true;
    takeSize();
    window_->SetMultiSamples(slow_ && restTimer_.isActive() ? 0 : kSamples);
    renderer_->ResetCameraClippingRange();
    vtkOpenGLState* state = window_->GetState();
    state->Reset();
    state->Push();
    // Qt's own drawing leaves the depth test as it likes.
    state->vtkglDepthFunc(GL_LEQUAL);
    state->vtkglEnable(GL_DEPTH_TEST);
    window_->Render();
    state->Pop();

    QOpenGLExtraFunctions* gl = context()->extraFunctions();
    gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER, defaultFramebufferObject());
    state->ResetFramebufferBindings();
    state->Reset();
    state->vtkglDisable(GL_SCISSOR_TEST);
    window_->BlitDisplayFramebuffer();
    // VTK leaves holes in alpha where it blends; the window would show through.
    gl->glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
    gl->glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
    gl->glClearColor(0, 0, 0, 1);
    gl->glClear(GL_COLOR_BUFFER_BIT);
    gl->glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->glFinish();
    painting_ = false;
    // The first frame loads drivers and compiles shaders, which says nothing about the next.
    if (++framesDrawn_ > 1 && timer.elapsed() > kSlow_ms)
        slow_ = true;
}

void SceneWidget::moved() {
    restTimer_.start(kRest_ms);
    emit cameraMovedByUser();
}

void SceneWidget::orbit(double right, double up) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    camera->Azimuth(-right * kRadian_deg);
    camera->Elevation(-up * kRadian_deg);
    camera->OrthogonalizeViewUp();
    moved();
    requestDraw();
}

void SceneWidget::zoom(double factor) {
    renderer_->GetActiveCamera()->Dolly(factor);
    moved();
    requestDraw();
}

void SceneWidget::tellPosition(const QPointF& position, Qt::KeyboardModifiers modifiers) {
    const double ratio = devicePixelRatioF();
    interactor_->SetEventInformationFlipY(
        static_cast<int>(std::lround(position.x() * ratio)), static_cast<int>(std::lround(position.y() * ratio)),
        modifiers.testFlag(Qt::ControlModifier) ? 1 : 0, modifiers.testFlag(Qt::ShiftModifier) ? 1 : 0);
}

void SceneWidget::mousePressEvent(QMouseEvent* event) {
    pressedAt_ = event->position();
    dragging_ = false;
    tellPosition(event->position(), event->modifiers());
    if (event->button() == Qt::LeftButton)
        interactor_->InvokeEvent(vtkCommand::LeftButtonPressEvent);
    else if (event->button() == Qt::MiddleButton)
        interactor_->InvokeEvent(vtkCommand::MiddleButtonPressEvent);
    else if (event->button() == Qt::RightButton)
        interactor_->InvokeEvent(vtkCommand::RightButtonPressEvent);
}

void SceneWidget::mouseMoveEvent(QMouseEvent* event) {
    const QPointF way = event->position() - pressedAt_;
    // A hand that trembles while it clicks does not turn the scene.
    if (event->buttons() == Qt::NoButton || (!dragging_ && std::hypot(way.x(), way.y()) < kClickRadius_px))
        return;
    dragging_ = true;
    moved();
    tellPosition(event->position(), event->modifiers());
    interactor_->InvokeEvent(vtkCommand::MouseMoveEvent);
}

void SceneWidget::mouseReleaseEvent(QMouseEvent* event) {
    tellPosition(event->position(), event->modifiers());
    if (event->button() == Qt::LeftButton)
        interactor_->InvokeEvent(vtkCommand::LeftButtonReleaseEvent);
    else if (event->button() == Qt::MiddleButton)
        interactor_->InvokeEvent(vtkCommand::MiddleButtonReleaseEvent);
    else if (event->button() == Qt::RightButton)
        interactor_->InvokeEvent(vtkCommand::RightButtonReleaseEvent);
    if (event->button() == Qt::LeftButton && !dragging_)
        emit clicked(event->position());
}

void SceneWidget::mouseDoubleClickEvent(QMouseEvent* event) {
    dragging_ = true;  // its release is no further click
    if (event->button() == Qt::LeftButton)
        emit doubleClicked();
}

void SceneWidget::wheelEvent(QWheelEvent* event) {
    // Touchpads send many small steps, mice few of 120.
    if (event->angleDelta().y() != 0)
        zoom(std::pow(1.15, event->angleDelta().y() / 120.0));
    event->accept();
}

bool SceneWidget::event(QEvent* event) {
    const bool result = QOpenGLWidget::event(event);
    // Another screen, another ratio of pixels.
    if (event->type() == QEvent::ScreenChangeInternal || event->type() == QEvent::Show)
        requestDraw();
    return result;
}

}  // namespace skincal
