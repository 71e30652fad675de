#pragma once

#include <vtkSmartPointer.h>

#include <QElapsedTimer>
#include <QPointF>
#include <QTimer>
#include <QWidget>

#include "ui/scene3d/scene_canvas.h"

class vtkGenericRenderWindowInteractor;

namespace skincal {

/// A VTK renderer inside a Qt window: left drag turns, shift or middle drag shifts, right drag and the wheel zoom.
/// Draws on the GUI thread, at most 30 times a second, only while it is shown, and only after requestDraw() or a camera
/// movement. Where the processor draws, edges are smoothed in pictures only, since that takes it several times as long.
/// Needs a platform with OpenGL (xcb, not offscreen). May be moved to another window, and destroyed at any time.
class SceneWidget : public QWidget {
    Q_OBJECT
  public:
    explicit SceneWidget(QWidget* parent = nullptr);
    ~SceneWidget() override;

    [[nodiscard]] vtkRenderer& renderer() const { return canvas_.renderer(); }

    /// Something has changed: draws soon. Cheap, however often it is called.
    void requestDraw();

    /// Without waiting for the frame's turn.
    void drawNow();

    /// Draws what there is in a small picture that nobody sees.
    void warmUp();

    /// Turns the camera about what it looks at, rad: to the right and upwards.
    void orbit(double right, double up);
    /// Goes nearer by a factor; below 1, further away.
    void zoom(double factor);

    /// The scene as it is now, smoothed, even where it is hidden; empty only where there is no OpenGL.
    [[nodiscard]] QImage grabPicture();

    /// Frames drawn since the beginning; for tests.
    [[nodiscard]] int framesDrawn() const { return framesDrawn_; }

  signals:
    /// The user has turned, shifted or zoomed.
    void cameraMovedByUser();
    /// A click without a drag, and where, in this widget's coordinates.
    void clicked(QPointF position);
    void doubleClicked();

  protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void showEvent(QShowEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;

  private:
    void tellPosition(const QPointF& position, Qt::KeyboardModifiers modifiers);
    [[nodiscard]] QSize sizeInPixels() const;

    SceneCanvas canvas_;
    vtkSmartPointer<vtkGenericRenderWindowInteractor> interactor_;
    QTimer drawTimer_;
    QElapsedTimer sinceFrame_;
    QPointF pressedAt_;
    bool dragging_ = false;
    int framesDrawn_ = 0;
};

}  // namespace skincal
