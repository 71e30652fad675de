#include "ui/pages/picture_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>

#include "ui/pages/page.h"
#include "ui/presenters/spot_evidence.h"
#include "ui/widgets/image_conversion.h"
#include "ui/widgets/picture_view.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

constexpr double kResidual_px = 30;  // how long most residuals are drawn, of the picture's pixels

// On a picture, which is dark whatever the theme.
const QColor kFound("#ffffff");
const QColor kSetAside("#ffb020");

const BodyView* solvedView(const Solution* solution, const std::string& name) {
    if (solution == nullptr)
        return nullptr;
    const auto& views = solution->body.views;
    const auto found = std::find_if(views.begin(), views.end(), [&](const BodyView& v) { return v.name == name; });
    return found == views.end() ? nullptr : &*found;
}

QPolygonF toPolygon(const std::vector<Vector2d>& corners) {
    QPolygonF polygon;
    for (const Vector2d& corner : corners)
        polygon << QPointF(corner.x(), corner.y());
    return polygon;
}

QPointF toPoint(const Vector2d& p) {
    return {p.x(), p.y()};
}

}  // namespace

PicturePanel::PicturePanel(Workbench& workbench, QWidget* parent)
    : QWidget(parent),
      workbench_(workbench),
      views_(new QComboBox),
      hidden_(new QCheckBox(tr("Hidden modules"))),
      picture_(new PictureView),
      summary_(mutedLabel()),
      figures_(new QLabel) {
    views_->setObjectName(QStringLiteral("overlayView"));
    views_->setAccessibleName(tr("View"));
    views_->setToolTip(tr("The view on whose picture the body is drawn, with the rms of its residuals"));
    views_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
    hidden_->setObjectName(QStringLiteral("overlayHidden"));
    hidden_->setToolTip(
        tr("Also outline, dotted, the modules that the camera can't see: those turned away or behind "
           "others"));
    picture_->setObjectName(QStringLiteral("overlay"));
    picture_->setAccessibleName(tr("The body on the picture of a view"));
    picture_->setToolTip(
        tr("Outlines: where the body has the modules. Rings: where their LEDs were found. Click one to "
           "see it in the 3D view; the wheel zooms, a drag shifts."));
    figures_->setObjectName(QStringLiteral("overlayFigures"));
    figures_->setWordWrap(true);
    auto* row = new QHBoxLayout;
    row->addWidget(mutedLabel(tr("View")));
    row->addWidget(views_);
    row->addWidget(hidden_);
    row->addStretch();
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(12, 12, 12, 12);
    column->setSpacing(8);
    column->addLayout(row);
    column->addWidget(picture_, 1);
    column->addWidget(figures_);
    column->addWidget(summary_);
    const Session& session = workbench.session();
    connect(&session, &Session::solutionChanged, this, &PicturePanel::listViews);
    connect(&session, &Session::viewsChanged, this, &PicturePanel::listViews);
    connect(views_, &QComboBox::currentIndexChanged, this, &PicturePanel::showView);
    connect(hidden_, &QCheckBox::toggled, this, &PicturePanel::showView);
    connect(picture_, &PictureView::markClicked, this, [this](ModuleId module) {
        picture_->setSelected(module);
        emit moduleSelected(module);
    });
    listViews();
}

void PicturePanel::setActive(bool active) {
    isActive_ = active;
    if (active && isStale_)
        showView();
}

void PicturePanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    if (isStale_)
        showView();
}

void PicturePanel::setSelected(std::optional<ModuleId> module) {
    picture_->setSelected(module);
}

QString PicturePanel::figures() const {
    return figures_->text();
}

void PicturePanel::listViews() {
    const QString before = views_->currentData().toString();
    {
        const QSignalBlocker blocker(views_);
        views_->clear();
        const auto& solution = workbench_.session().solution();
        for (const ScannedView& view : workbench_.session().measured().views) {
            const QString name = QString::fromStdString(view.name);
            const BodyView* solved = solvedView(solution.get(), view.name);
            views_->addItem(solved != nullptr && solved->residual_rms_px
                                ? tr("%1  (%2 px)").arg(name).arg(*solved->residual_rms_px, 0, 'f', 2)
                                : name,
                            name);
        }
        views_->setCurrentIndex(std::max(0, views_->findData(before)));
        views_->setEnabled(views_->count() > 0);
    }
    showView();
}

void PicturePanel::showPicture(const std::string& name) {
    const ScannedView* view = workbench_.session().findView(name);
    const auto& camera = workbench_.session().decisions().camera;
    hasPicture_ = view != nullptr && view->pictures && !view->pictures->empty();
    if (hasPicture_) {
        // The second picture of a coded scan has all LEDs on.
        picture_->setImage(toImage(pictureOf(*view)));
    } else if (camera && view != nullptr) {
        QImage blank(camera->width, camera->height, QImage::Format_RGB32);
        blank.fill(QColor("#2b2f37"));
        picture_->setImage(blank);
    } else {
        picture_->setImage({});
    }
}

void PicturePanel::showView() {
    isStale_ = !isActive_ || !isVisible();
    if (isStale_)
        return;
    const std::string name = views_->currentData().toString().toStdString();
    const auto& solution = workbench_.session().solution();
    picture_->setShapes({});
    picture_->setMarks({});
    figures_->clear();
    summary_->clear();
    if (name.empty()) {
        picture_->setImage({});
        picture_->setPlaceholder(tr("No view yet. Scan one, and the body is drawn on its picture here."));
        return;
    }
    showPicture(name);
    const BodyView* solved = solvedView(solution.get(), name);
    if (solved == nullptr || !solved->T_body_camera) {
        const bool isDropped = workbench_.session().decisions().droppedViews.contains(name);
        figures_->setText(isDropped
                              ? tr("This view is dropped: the body does not know where its camera stood.")
                              : tr("Where this view's camera stood is not known: the body can't be drawn on it."));
        return;
    }
    // The lens that the body was solved with: another may have been given since.
    showOverlay(overlayOf(solution->body, *solved, solution->measurements->camera));
}

void PicturePanel::showOverlay(const ModelOverlay& overlay) {
    const double scale = residualScale(overlay, kResidual_px);
    std::vector<PictureShape> shapes;
    std::vector<PictureMark> marks;
    std::size_t hidden = 0;
    for (const OverlayModule& module : overlay.modules) {
        const bool isHidden = module.sight != OverlayModule::Sight::Open && !module.found;
        hidden += isHidden ? 1 : 0;
        if (!isHidden || hidden_->isChecked())
            shapes.push_back({toPolygon(module.outline),
                              module.patch ? patchTint(module.patch->value) : QColor("#999999"), module.module,
                              isHidden});
        if (!module.found)
            continue;
        PictureMark mark{toPoint(*module.found), module.counts ? kFound : kSetAside, module.module, !module.counts};
        if (module.residual)
            mark.expected = toPoint(*module.found - (module.counts ? scale : 1) * *module.residual);
        // Small enough to leave the outline of its board in sight.
        mark.radius = 3.5;
        marks.push_back(mark);
    }
    // What can be seen lies over what can't.
    std::stable_partition(shapes.begin(), shapes.end(), [](const PictureShape& shape) { return shape.isDim; });
    picture_->setShapes(std::move(shapes));
    picture_->setMarks(std::move(marks));
    QString figures = overlay.rms_px ? tr("%n spots count: %1 px rms, %2 px median, worst %3 px (module %4)", nullptr,
                                          static_cast<int>(overlay.counted))
                                           .arg(*overlay.rms_px, 0, 'f', 3)
                                           .arg(overlay.median_px.value_or(0), 0, 'f', 3)
                                           .arg(overlay.worst_px, 0, 'f', 3)
                                           .arg(overlay.worst.value)
                                     : tr("No spot of this view counts.");
    figures_->setText(figures);
    QString words = tr("%1 set aside, %2 in the open but not found, %3 hidden.")
                        .arg(overlay.setAside)
                        .arg(overlay.missed)
                        .arg(hidden);
    if (overlay.rms_px)
        words += scale > 1 ? tr(" Lines lead to where the body has the spot, %L1 times as long as it is away.")
                                 .arg(scale, 0, 'f', 0)
                           : tr(" Lines lead to where the body has the spot.");
    if (!hasPicture_)
        words += tr(" This view was recorded without pictures: the frame is blank.");
    summary_->setText(words);
}

}  // namespace skincal
