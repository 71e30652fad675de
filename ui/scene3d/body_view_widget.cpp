#include "ui/scene3d/body_view_widget.h"

#include <vtkCamera.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include <QPainter>
#include <QResizeEvent>
#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/skin/module_template.h"
#include "ui/scene3d/body_actors.h"
#include "ui/scene3d/body_scene.h"
#include "ui/scene3d/scene_widget.h"

namespace skincal {

BodyViewWidget::BodyViewWidget(QWidget* parent)
    : QWidget(parent),
      scene_(new SceneWidget(this)),
      overlay_(new SceneOverlay(*scene_->renderer().GetActiveCamera(), this)),
      actors_(std::make_unique<BodyActors>(scene_->renderer())) {
    setFocusPolicy(Qt::StrongFocus);
    scene_->setFocusPolicy(Qt::NoFocus);
    connect(scene_, &SceneWidget::cameraMovedByUser, this, [this] { movedByUser_ = true; });
    connect(scene_, &SceneWidget::clicked, this, &BodyViewWidget::click);
    connect(scene_, &SceneWidget::doubleClicked, this, &BodyViewWidget::fitView);
    actors_->setDark(dark_);
    warmUp();
    updateWords();
}

void BodyViewWidget::warmUp() {
    BodyModel cell;
    cell.templates = {paperHexagon()};
    BodyModule& module = cell.modules.emplace_back();
    module.type = cell.templates.front().name;
    module.T_body_module = Isometry3d::Identity();
    module.covariance = 1e-6 * Matrix6d::Identity();
    cell.views.emplace_back().T_body_camera = Isometry3d::Identity();
    const SceneLayout layout = layOut(cell);
    actors_->show(cell, layout);
    actors_->setCamerasShown(true);
    actors_->setEllipsoids(cell, 1);
    actors_->setSelected(layout, std::vector{module.id});
    actors_->setGuideCamera(Isometry3d::Identity(), layout.radius);
    actors_->setGuideUp(Vector3d::UnitZ(), layout);
    actors_->setContacts(std::vector{ContactMark{Vector3d::Zero(), Vector3d::UnitZ(), layout.radius}});
    actors_->setMesh(boardsOf(cell));
    scene_->warmUp();
    actors_->setMesh(nullptr);
    actors_->clear();
}

BodyViewWidget::~BodyViewWidget() {
    // Before what the actors and the overlay stand on, whatever order Qt takes children in.
    delete overlay_;
    actors_.reset();
    delete scene_;
}

void BodyViewWidget::setBody(std::shared_ptr<const BodyModel> body) {
    if (body == body_)
        return;
    const bool wasEmpty = layout_.modules.empty();
    const bool wasPlaced = layout_.anyPlaced;
    body_ = std::move(body);
    setContacts({});
    layout_ = body_ ? layOut(*body_) : SceneLayout{};
    if (body_)
        actors_->show(*body_, layout_);
    else
        actors_->clear();
    findValues();
    const auto gone = [&](ModuleId id) { return layout_.find(id) == nullptr; };
    if (std::any_of(measured_.begin(), measured_.end(), gone))
        measured_.clear();
    outlineSelected();
    actors_->setCamerasShown(cameras_ && !layout_.modules.empty());
    updateGuides();
    updateEllipsoids();
    recolour();
    // What was looked at is no longer where it was.
    const bool anew = wasEmpty || wasPlaced != layout_.anyPlaced;
    updateWords();
    if (anew || !movedByUser_)
        resetView();
}

void BodyViewWidget::findValues() {
    if (!body_)
        values_ = std::nullopt;
    else
        values_ = mode_ == ColourMode::Deviation ? deviations_mm(*body_, deviations_) : valuesOf(*body_, mode_);
}

void BodyViewWidget::recolour() {
    actors_->setColours(coloursOf(layout_, mode_, values_, live_, dark_));
    scene_->requestDraw();
}

void BodyViewWidget::setColourMode(ColourMode mode) {
    if (mode == mode_)
        return;
    mode_ = mode;
    findValues();
    recolour();
    updateWords();
}

void BodyViewWidget::setEllipsoidsShown(bool shown) {
    if (shown == ellipsoids_)
        return;
    ellipsoids_ = shown;
    updateEllipsoids();
    updateWords();
}

void BodyViewWidget::updateEllipsoids() {
    const bool known = body_ && std::any_of(body_->modules.begin(), body_->modules.end(), [](const BodyModule& module) {
                           return module.covariance && module.T_body_module;
                       });
    ellipsoidScale_ = ellipsoids_ && known ? ellipsoidScale(*body_) : 0;
    if (body_)
        actors_->setEllipsoids(*body_, ellipsoidScale_);
    scene_->requestDraw();
}

void BodyViewWidget::setCamerasShown(bool shown) {
    cameras_ = shown;
    actors_->setCamerasShown(shown && !layout_.modules.empty());
    scene_->requestDraw();
    updateWords();
}

void BodyViewWidget::setGuideCamera(const std::optional<Isometry3d>& T_r_v) {
    const bool isOther = T_r_v.has_value() != guideCamera_.has_value() || (T_r_v && !T_r_v->isApprox(*guideCamera_));
    guideCamera_ = T_r_v;
    updateGuides();
    updateWords();
    if (isOther && !movedByUser_ && layout_.anyPlaced)
        lookAt(bodyPoints(), false);
}

void BodyViewWidget::setGuideUp(const std::optional<Vector3d>& up_r) {
    if (up_r && !(up_r->norm() > 1e-9))
        throw std::logic_error("BodyViewWidget: no direction is up");
    guideUp_ = up_r;
    updateGuides();
    updateWords();
    if (!movedByUser_)
        resetView();
}

void BodyViewWidget::updateGuides() {
    // Both are in the body frame, which has no place in the scene before the first patch has.
    const bool shown = layout_.anyPlaced;
    actors_->setGuideCamera(shown ? guideCamera_ : std::nullopt, 2 * BodyActors::cameraSize(layout_));
    actors_->setGuideUp(shown ? guideUp_ : std::nullopt, layout_);
    scene_->requestDraw();
}

void BodyViewWidget::setSelected(std::vector<ModuleId> modules) {
    if (modules == selected_)
        return;
    selected_ = std::move(modules);
    outlineSelected();
    updateWords();
}

void BodyViewWidget::setContacts(std::vector<ContactMark> contacts) {
    if (contacts.empty() && contacts_.empty())
        return;
    contacts_ = std::move(contacts);
    actors_->setContacts(contacts_);
    scene_->requestDraw();
}

void BodyViewWidget::outlineSelected() {
    std::vector<ModuleId> outlined = selected_;
    if (current_ && areKeysAt(*current_))
        outlined.push_back(*current_);
    actors_->setSelected(layout_, outlined);
    scene_->requestDraw();
}

void BodyViewWidget::setMesh(vtkPolyData* mesh) {
    isMeshShown_ = mesh != nullptr;
    meshBox_.setEmpty();
    if (mesh != nullptr && mesh->GetNumberOfPoints() > 0) {
        std::array<double, 6> bounds{};
        mesh->GetBounds(bounds.data());
        meshBox_.extend(Vector3d(bounds[0], bounds[2], bounds[4]));
        meshBox_.extend(Vector3d(bounds[1], bounds[3], bounds[5]));
    }
    actors_->setMesh(mesh);
    scene_->requestDraw();
}

void BodyViewWidget::setDeviations(std::map<ModuleId, double> deviations) {
    deviations_ = std::move(deviations);
    if (mode_ != ColourMode::Deviation)
        return;
    findValues();
    recolour();
    updateWords();
}

void BodyViewWidget::setDark(bool dark) {
    if (dark == dark_)
        return;
    dark_ = dark;
    actors_->setDark(dark);
    recolour();
    updateWords();
}

void BodyViewWidget::setCellValues(std::span<const float> values) {
    live_.assign(values.begin(), values.end());
    if (mode_ == ColourMode::Values)
        recolour();
}

void BodyViewWidget::setCellHeights(std::span<const float> heights) {
    std::vector<float> shown;
    shown.reserve(layout_.modules.size());
    for (const ShownModule& module : layout_.modules)
        shown.push_back(module.index < heights.size() ? heights[module.index] : 0.0F);
    actors_->setHeights(shown);
    scene_->requestDraw();
}

void BodyViewWidget::setValueWords(const QString& title, const QString& low, const QString& high) {
    valueTitle_ = title;
    valueLow_ = low;
    valueHigh_ = high;
    updateWords();
}

void BodyViewWidget::setMeasuring(bool measuring) {
    if (measuring == measuring_)
        return;
    measuring_ = measuring;
    measured_.clear();
    scene_->setCursor(measuring ? Qt::CrossCursor : Qt::ArrowCursor);
    updateWords();
}

QImage BodyViewWidget::grabPicture() {
    QImage picture = scene_->grabPicture();
    if (picture.isNull())
        return {};
    QPainter painter(&picture);
    overlay_->render(&painter, QPoint(), QRegion(), QWidget::DrawChildren);
    return picture;
}

void BodyViewWidget::resizeEvent(QResizeEvent* /*event*/) {
    scene_->setGeometry(rect());
    overlay_->setGeometry(rect());
    overlay_->raise();
    if (!movedByUser_)
        resetView();
}

void BodyViewWidget::changeEvent(QEvent* event) {
    if (event->type() == QEvent::LanguageChange || event->type() == QEvent::FontChange)
        updateWords();
    QWidget::changeEvent(event);
}

}  // namespace skincal
