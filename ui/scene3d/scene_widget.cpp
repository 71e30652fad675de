#include "ui/scene3d/scene_widget.h"

#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkGenericRenderWindowInteractor.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkRenderer.h>

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

namespace skincal {
namespace {

constexpr int kFrame_ms = 33;
constexpr double kClickRadius_px = 4;
constexpr double kRadian_deg = 57.29577951308232;

}  // namespace

SceneWidget::SceneWidget(QWidget* parent)
    : QWidget(parent), interactor_(vtkSmartPointer<vtkGenericRenderWindowInteractor>::New()) {
    setAttribute(Qt::WA_OpaquePaintEvent);
    const auto style = vtkSmartPointer<vtkInteractorStyleTrackballCamera>::New();
    style->SetMotionFactor(8);
    interactor_->SetInteractorStyle(style);
    interactor_->SetRenderWindow(&canvas_.window());
    // The style asks for a frame at every move; frames come at their own pace.
    interactor_->EnableRenderOff();
    interactor_->AddObserver(vtkCommand::RenderEvent, this, &SceneWidget::requestDraw);
    interactor_->Initialize();

    drawTimer_.setSingleShot(true);
    connect(&drawTimer_, &QTimer::timeout, this, &SceneWidget::drawNow);
}

SceneWidget::~SceneWidget() {
    interactor_->SetRenderWindow(nullptr);
    canvas_.window().SetInteractor(nullptr);
    interactor_->RemoveAllObservers();
}

void SceneWidget::requestDraw() {
    if (drawTimer_.isActive())
        return;
    const qint64 since = sinceFrame_.isValid() ? sinceFrame_.elapsed() : kFrame_ms;
    drawTimer_.start(static_cast<int>(std::clamp<qint64>(kFrame_ms - since, 0, kFrame_ms)));
}

QSize SceneWidget::sizeInPixels() const {
    return (QSizeF(size()) * devicePixelRatioF()).toSize();
}

void SceneWidget::drawNow() {
    // What nobody sees is drawn where it is shown again.
    if (!isVisible())
        return;
    sinceFrame_.start();
    canvas_.draw(sizeInPixels(), devicePixelRatioF(), !canvas_.isSoftware());
    ++framesDrawn_;
    update();
}

void SceneWidget::warmUp() {
    constexpr QSize kSmall(16, 16);
    renderer().ResetCamera();
    canvas_.draw(kSmall, 1, !canvas_.isSoftware());
}

QImage SceneWidget::grabPicture() {
    return canvas_.draw(sizeInPixels(), devicePixelRatioF(), true);
}

void SceneWidget::paintEvent(QPaintEvent* /*event*/) {
    QPainter painter(this);
    // Between a resize and the next frame the last one has another size.
    if (canvas_.picture().isNull())
        painter.fillRect(rect(), palette().window());
    else
        painter.drawImage(rect(), canvas_.picture());
}

void SceneWidget::resizeEvent(QResizeEvent* /*event*/) {
    const QSize size = sizeInPixels();
    interactor_->UpdateSize(size.width(), size.height());
    requestDraw();
}

void SceneWidget::showEvent(QShowEvent* /*event*/) {
    requestDraw();
}

void SceneWidget::orbit(double right, double up) {
    vtkCamera* camera = renderer().GetActiveCamera();
    camera->Azimuth(-right * kRadian_deg);
    camera->Elevation(-up * kRadian_deg);
    camera->OrthogonalizeViewUp();
    emit cameraMovedByUser();
    requestDraw();
}

void SceneWidget::zoom(double factor) {
    renderer().GetActiveCamera()->Dolly(factor);
    emit cameraMovedByUser();
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
    emit cameraMovedByUser();
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

}  // namespace skincal
