#pragma once

#include <vtkSmartPointer.h>

#include <QElapsedTimer>
#include <QMetaObject>
#include <QOpenGLWidget>
#include <QPointF>
#include <QTimer>

class vtkGenericOpenGLRenderWindow;
class vtkGenericRenderWindowInteractor;
class vtkObject;
class vtkRenderer;

namespace skincal {

/// A VTK renderer inside a Qt window: left drag turns, shift or middle drag shifts, right drag and the wheel zoom.
/// Draws on the GUI thread, at most 30 times a second, and only after requestDraw() or a camera movement. Where the
/// computer draws slowly, edges are smoothed only while nothing moves.
/// Needs QApplication's default QSurfaceFormat to be sceneFormat(), and a platform with OpenGL (xcb, not offscreen).
/// May be moved to another window, and destroyed at any time; what was put into renderer() goes with it.
class SceneWidget : public QOpenGLWidget {
    Q_OBJECT
  public:
    explicit SceneWidget(QWidget* parent = nullptr);
    ~SceneWidget() override;

    /// OpenGL 3.2 core, for QSurfaceFormat::setDefaultFormat before the application is made.
    [[nodiscard]] static QSurfaceFormat sceneFormat();

    [[nodiscard]] vtkRenderer& renderer() const;

    /// Something has changed: draws soon. Cheap, however often it is called.
    void requestDraw();

    /// The same for one of many changes in a row, which matter more than smooth edges where drawing is slow.
    void animate();

    /// Turns the camera about what it looks at, rad: to the right and upwards.
    void orbit(double right, double up);
    /// Goes nearer by a factor; below 1, further away.
    void zoom(double factor);

    /// Frames drawn since the beginning; for tests.
    [[nodiscard]] int framesDrawn() const { return framesDrawn_; }

  signals:
    /// Just before a frame, at the pace of the frames: what is painted over the scene can follow now.
    void aboutToDraw();
    /// The user has turned, shifted or zoomed.
    void cameraMovedByUser();
    /// A click without a drag, and where, in this widget's coordinates.
    void clicked(QPointF position);
    void doubleClicked();

  protected:
    void initializeGL() override;
    void paintGL() override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    bool event(QEvent* event) override;

  private:
    void makeCurrentForVtk(vtkObject* caller, unsigned long event, void* data);
    void answerIsCurrent(vtkObject* caller, unsigned long event, void* data);
    void answerYes(vtkObject* caller, unsigned long event, void* data);
    void drawLater(vtkObject* caller, unsigned long event, void* data);
    void releaseGraphics();
    void tellPosition(const QPointF& position, Qt::KeyboardModifiers modifiers);
    void moved();
    void drawNow();
    void takeSize();

    vtkSmartPointer<vtkGenericOpenGLRenderWindow> window_;
    vtkSmartPointer<vtkGenericRenderWindowInteractor> interactor_;
    vtkSmartPointer<vtkRenderer> renderer_;
    QMetaObject::Connection contextGoes_;
    QTimer drawTimer_;
    QTimer restTimer_;  ///< runs while something moves
    QElapsedTimer sinceFrame_;
    QPointF pressedAt_;
    bool dragging_ = false;
    bool slow_ = false;
    bool painting_ = false;
    int framesDrawn_ = 0;
};

}  // namespace skincal
