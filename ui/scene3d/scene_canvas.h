#pragma once

#include <vtkSmartPointer.h>

#include <QImage>
#include <QOffscreenSurface>
#include <QOpenGLContext>

class vtkGenericOpenGLRenderWindow;
class vtkRenderer;

namespace skincal {

/// Draws what is in a VTK renderer into pictures, by an OpenGL 3.2 context of its own that belongs to no window: a
/// window that shows it is composed by Qt without OpenGL, which is what a software renderer is slowest at. GUI thread.
class SceneCanvas {
  public:
    /// Loads the drivers.
    SceneCanvas();
    ~SceneCanvas();
    SceneCanvas(const SceneCanvas&) = delete;
    SceneCanvas& operator=(const SceneCanvas&) = delete;

    [[nodiscard]] vtkRenderer& renderer() const;
    [[nodiscard]] vtkGenericOpenGLRenderWindow& window() const;

    /// Whether the processor draws in the place of a graphics card.
    [[nodiscard]] bool isSoftware() const { return isSoftware_; }

    /// @param size    of the picture, pixels; @param ratio of pixels to Qt's.
    /// @param smooth  edges are smoothed, which takes several times as long.
    /// @return kept until the next one; empty where there is no OpenGL.
    const QImage& draw(const QSize& size, double ratio, bool smooth);
    /// The last one.
    [[nodiscard]] const QImage& picture() const { return picture_; }

  private:
    QOffscreenSurface surface_;
    QOpenGLContext context_;
    vtkSmartPointer<vtkGenericOpenGLRenderWindow> window_;
    vtkSmartPointer<vtkRenderer> renderer_;
    QImage upsideDown_;  ///< as OpenGL gives it
    QImage picture_;
    bool isSoftware_ = false;
};

}  // namespace skincal
