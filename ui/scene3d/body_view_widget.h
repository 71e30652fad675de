#pragma once

#include <QImage>
#include <QWidget>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/estimation/body_model.h"
#include "ui/scene3d/body_words.h"
#include "ui/scene3d/scene_glyphs.h"
#include "ui/scene3d/scene_layout.h"

class vtkPolyData;

namespace skincal {

class BodyActors;
class SceneOverlay;
class SceneWidget;

/// The body as it grows: a live 3D view of snapshots of a body model, in the body frame. Everything is on the GUI
/// thread; snapshots are shared, never changed.
///
/// Patches without a pose in the body lie side by side, and a caption says so. The user's camera is kept from snapshot
/// to snapshot; as long as the user has not moved it, it follows the body, and it starts anew where the scene was empty
/// or the first patch finds its place.
///
/// Mouse: drag turns, shift or the middle button shifts, wheel or the right button zoom, a click picks a module, a
/// double click fits the view. Keys: arrows turn, + and - zoom, F fits the view, Home looks from the front; Page Up and
/// Page Down go from module to module, Return does there what a click does; Escape forgets a measurement.
class BodyViewWidget : public QWidget {
    Q_OBJECT
  public:
    explicit BodyViewWidget(QWidget* parent = nullptr);
    ~BodyViewWidget() override;

    /// Shows a snapshot; none empties the view. The same snapshot again costs nothing.
    void setBody(std::shared_ptr<const BodyModel> body);
    [[nodiscard]] const std::shared_ptr<const BodyModel>& body() const { return body_; }

    void setColourMode(ColourMode mode);
    [[nodiscard]] ColourMode colourMode() const { return mode_; }
    /// Ellipsoids of three standard deviations about placed modules; the legend tells how they are enlarged.
    void setEllipsoidsShown(bool shown);
    void setCamerasShown(bool shown);

    /// A ghost of the camera where to stand next (T_body_camera), with words beside it, in view unless the user has
    /// moved that.
    void setGuideCamera(const std::optional<Isometry3d>& T_r_v);
    /// An arrow along the direction, body frame, that should point up next. Throws std::logic_error for zero.
    void setGuideUp(const std::optional<Vector3d>& up_r);

    /// Modules with an outline round them; up to twelve bear their number. Unknown ids are ignored. Kept over
    /// snapshots.
    void setSelected(std::vector<ModuleId> modules);
    [[nodiscard]] const std::vector<ModuleId>& selected() const { return selected_; }

    /// While measuring, two clicks show the distance between two LEDs; clicks select nothing then.
    void setMeasuring(bool measuring);
    [[nodiscard]] bool measuring() const { return measuring_; }

    /// The robot's surface, body frame, m, drawn translucent round the skin; null takes it away.
    void setMesh(vtkPolyData* mesh);
    [[nodiscard]] bool isMeshShown() const { return isMeshShown_; }
    /// How far modules lie above (or, negative, below) that surface, m; shown in ColourMode::Deviation, where modules
    /// without one count as unknown.
    void setDeviations(std::map<ModuleId, double> deviations);

    void setDark(bool dark);
    [[nodiscard]] bool dark() const { return dark_; }

    /// Values from 0 to 1 by position in BodyModel::modules, shown in ColourMode::Values; missing ones and NaN count as
    /// unknown. Only colours change, not geometry: 30 times a second for 1,000 modules is well within reach.
    void setCellValues(std::span<const float> values);
    /// How far each module's face stands out along its normal, m, likewise; 0 for missing ones. Forgotten with the
    /// snapshot.
    void setCellHeights(std::span<const float> heights);
    /// An arrow on the skin for each. Forgotten with the snapshot.
    void setContacts(std::vector<ContactMark> contacts);
    [[nodiscard]] const std::vector<ContactMark>& contacts() const { return contacts_; }
    /// What 0 and 1 of setCellValues stand for.
    void setValueWords(const QString& title, const QString& low, const QString& high);

    /// Moves the camera, in the direction it looks, to where it has the whole body in view, and the mesh about it.
    void fitView();
    /// The same with all cameras, the guide's included.
    void fitEverything();
    /// Looks at the body from where most boards face.
    void resetView();

    /// The view as it is now, legend included, at the screen's resolution. Drawn at once, even where hidden; empty only
    /// where there is no OpenGL.
    [[nodiscard]] QImage grabPicture();

    /// The module whose board is drawn at a place of this widget.
    [[nodiscard]] std::optional<ModuleId> moduleAt(const QPointF& position) const;
    /// Where on which board.
    [[nodiscard]] std::optional<ScenePick> pickAt(const QPointF& position) const;
    /// Where a point of the scene (for placed modules, the body frame) is drawn in this widget.
    [[nodiscard]] std::optional<QPointF> positionOf(const Vector3d& point) const;
    [[nodiscard]] const SceneLayout& layoutShown() const { return layout_; }
    /// Words and legend that are shown; for tests and screen readers.
    [[nodiscard]] const SceneOverlay& overlay() const { return *overlay_; }
    [[nodiscard]] SceneWidget& scene() const { return *scene_; }

    [[nodiscard]] QSize sizeHint() const override { return {640, 480}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {160, 120}; }

  signals:
    void moduleClicked(skincal::ModuleId module);
    /// A click beside the body.
    void nothingClicked();
    /// Two LEDs were measured; m.
    void measured(skincal::ModuleId from, skincal::ModuleId to, double distance);

  protected:
    void keyPressEvent(QKeyEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;
    void changeEvent(QEvent* event) override;

  private:
    /// Shaders are compiled where a thing is first drawn: here, before there is a window to wait for, all of them.
    void warmUp();
    void click(const QPointF& position);
    void choose(ModuleId module);
    /// The keys go on by so many modules.
    void stepModules(int way);
    void outlineSelected();
    [[nodiscard]] bool areKeysAt(ModuleId module) const { return focusFrame_ && current_ == module; }
    void measureTo(ModuleId module);
    void findValues();
    void recolour();
    void updateEllipsoids();
    void updateGuides();
    void updateWords();
    [[nodiscard]] std::vector<SceneLabel> labels() const;
    [[nodiscard]] std::vector<Vector3d> measurePoints() const;
    [[nodiscard]] std::vector<Vector3d> bodyPoints() const;  ///< what fitView has in view
    void lookAt(std::span<const Vector3d> points, bool anew);

    SceneWidget* scene_;
    SceneOverlay* overlay_;
    std::unique_ptr<BodyActors> actors_;
    std::shared_ptr<const BodyModel> body_;
    SceneLayout layout_;
    std::optional<ModuleValues> values_;
    std::vector<float> live_;
    std::map<ModuleId, double> deviations_;
    QString valueTitle_, valueLow_, valueHigh_;
    ColourMode mode_ = ColourMode::Patch;
    double ellipsoidScale_ = 0;  ///< 0 while they are hidden
    bool ellipsoids_ = false;
    bool cameras_ = true;
    bool dark_ = true;
    bool measuring_ = false;
    bool isMeshShown_ = false;
    Eigen::AlignedBox3d meshBox_;  ///< empty where there is none
    bool movedByUser_ = false;
    bool focusFrame_ = false;
    std::optional<Isometry3d> guideCamera_;
    std::optional<Vector3d> guideUp_;
    std::vector<ModuleId> selected_;
    std::optional<ModuleId> current_;  ///< where the keys are
    std::vector<ModuleId> measured_;   ///< at most two
    std::vector<ContactMark> contacts_;
};

}  // namespace skincal
