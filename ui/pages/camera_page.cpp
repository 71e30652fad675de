#include "ui/pages/camera_page.h"

#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QPushButton>
#include <QSlider>
#include <cmath>

#include "core/formats/camera_file.h"
#include "ui/pages/calibration_dialog.h"
#include "ui/presenters/camera_words.h"
#include "ui/widgets/histogram_view.h"
#include "ui/widgets/image_conversion.h"
#include "ui/widgets/picture_view.h"
#include "ui/widgets/primary_button.h"

namespace skincal {
namespace {

constexpr int kSliderSteps = 100;
constexpr int kShownLetters = 10;  // of the names of cameras, which may be long

}  // namespace

CameraPage::CameraPage(Workbench& workbench, ScanPresenter& scan, QWidget* parent)
    : Page(tr("Camera"),
           tr("Choose the camera, see that the picture is sharp and not too bright, and say what its lens does."),
           parent),
      workbench_(workbench),
      scan_(scan),
      board_(workbench, scan),
      devices_(new QComboBox),
      formats_(new QComboBox),
      exposure_(new QSlider(Qt::Horizontal)),
      exposureText_(mutedLabel()),
      picture_(new PictureView),
      histogram_(new HistogramView),
      figures_(mutedLabel()),
      intrinsics_(new QLabel),
      load_(new QPushButton(tr("Load …"))),
      makers_(new QPushButton(tr("Use the maker's intrinsics"))),
      calibrate_(new QPushButton(tr("Calibrate here …"))) {
    auto* top = new QHBoxLayout;
    devices_->setAccessibleName(tr("Camera"));
    devices_->setToolTip(tr("The camera that looks at the body"));
    for (QComboBox* box : {devices_, formats_}) {
        box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
        box->setMinimumContentsLength(kShownLetters);
    }
    for (const auto& offer : workbench.cameraOffers)
        devices_->addItem(offer.name);
    formats_->setAccessibleName(tr("Resolution"));
    formats_->setToolTip(tr("Size and rate of the pictures; intrinsics hold for one size"));
    exposure_->setRange(0, kSliderSteps);
    exposure_->setAccessibleName(tr("Exposure"));
    exposure_->setToolTip(tr("Shorten it until LEDs are bright and not clipped"));
    top->addWidget(devices_, 3);
    top->addWidget(formats_, 3);
    top->addWidget(new QLabel(tr("Exposure")));
    exposure_->setMinimumWidth(60);
    top->addWidget(exposure_, 4);
    exposureText_->setMinimumWidth(64);
    top->addWidget(exposureText_);
    body().addLayout(top);
    picture_->setPlaceholder(tr("The camera's picture appears here."));
    body().addWidget(picture_, 1);
    auto* below = new QHBoxLayout;
    auto* left = new QVBoxLayout;
    left->addWidget(histogram_, 1);
    left->addWidget(figures_);
    below->addLayout(left, 1);
    auto* right = new QVBoxLayout;
    intrinsics_->setWordWrap(true);
    right->addWidget(intrinsics_);
    right->addWidget(mutedLabel(tr("Reads ROS camera_info YAML, OpenCV YAML or XML, and Kalibr camchain YAML.")));
    auto* buttons = new QHBoxLayout;
    load_->setObjectName(QStringLiteral("loadIntrinsics"));
    load_->setToolTip(tr("A file with focal lengths, centre and distortion of this camera at this size"));
    makers_->setObjectName(QStringLiteral("makersIntrinsics"));
    makers_->setToolTip(tr("The simulated camera knows its own lens"));
    makers_->setVisible(workbench.hands && workbench.hands->intrinsics);
    calibrate_->setObjectName(QStringLiteral("calibrateHere"));
    calibrate_->setToolTip(tr("Show a printed chessboard or ChArUco board to this camera and get its intrinsics"));
    buttons->addWidget(makers_);
    buttons->addWidget(calibrate_);
    buttons->addWidget(load_);
    buttons->addStretch();
    right->addStretch();
    below->addLayout(right, 2);
    body().addLayout(below);
    // Not beside the histogram: three buttons are wide.
    body().addLayout(buttons);

    connect(devices_, &QComboBox::activated, this, [this](int offer) {
        if (offer != workbench_.chosenCamera())
            workbench_.chooseCamera(static_cast<std::size_t>(offer));
    });
    connect(formats_, &QComboBox::activated, this, [this](int index) {
        if (FrameSource* camera = workbench_.camera())
            camera->setFormat(camera->formats().at(static_cast<std::size_t>(index)));
        refresh();
    });
    connect(exposure_, &QSlider::valueChanged, this, [this](int step) {
        FrameSource* camera = workbench_.camera();
        if (camera == nullptr || !camera->exposureRange())
            return;
        const auto [shortest, longest] = *camera->exposureRange();
        camera->setExposure(shortest * std::pow(longest / shortest, static_cast<double>(step) / kSliderSteps));
        refresh();
    });
    connect(load_, &QPushButton::clicked, this, [this] {
        const QString file = QFileDialog::getOpenFileName(this, tr("Intrinsics"), {},
                                                          tr("Camera files (*.yaml *.yml *.xml);;All files (*)"));
        if (!file.isEmpty())
            loadIntrinsics(file);
    });
    connect(makers_, &QPushButton::clicked, this, [this] {
        CameraOrigin origin;
        origin.kind = CameraOrigin::Kind::Nominal;
        adopt(*workbench_.hands->intrinsics, std::move(origin), tr("Use the maker's intrinsics"));
    });
    connect(calibrate_, &QPushButton::clicked, this, &CameraPage::calibrateHere);
    connect(&workbench, &Workbench::cameraChosen, this, &CameraPage::listFormats);
    connect(&workbench.session(), &Session::decisionsChanged, this, &CameraPage::refresh);
    connect(&scan, &ScanPresenter::pictureChanged, this, [this] {
        if (isActive_)
            showPicture();
    });
    listFormats();
}

CameraPage::~CameraPage() {
    // Before the presenter that it shows.
    delete dialog_;
}

void CameraPage::setActive(bool active) {
    isActive_ = active;
    if (active && workbench_.camera() == nullptr && !workbench_.cameraOffers.empty())
        workbench_.chooseCamera(0);
    // Whoever does something else has put the board away.
    if (!active && dialog_ != nullptr)
        dialog_->close();
    scan_.setActive(active);
    refresh();
}

void CameraPage::calibrateHere() {
    if (dialog_ == nullptr)
        dialog_ = new CalibrationDialog(board_, scan_, this);
    dialog_->show();
    dialog_->raise();
}

void CameraPage::loadIntrinsics(const QString& file) {
    const auto camera = readCameraModel(file.toStdString());
    if (!camera) {
        emit failed(QString::fromStdString(camera.error().message()));
        return;
    }
    CameraOrigin origin;
    origin.kind = CameraOrigin::Kind::File;
    origin.file = QFileInfo(file).fileName().toStdString();
    adopt(*camera, std::move(origin), tr("Load intrinsics"));
}

void CameraPage::adopt(const CameraModel& camera, CameraOrigin origin, const QString& text) {
    origin.date = today();
    workbench_.session().decide(text, [&](Decisions& decisions) {
        decisions.camera = camera;
        decisions.cameraOrigin = std::move(origin);
    });
}

void CameraPage::listFormats() {
    formats_->clear();
    if (const FrameSource* camera = workbench_.camera()) {
        devices_->setCurrentIndex(workbench_.chosenCamera());
        for (const FrameFormat& format : camera->formats()) {
            formats_->addItem(tr("%1 × %2, %3 /s").arg(format.width).arg(format.height).arg(format.framesPerSecond));
            if (format == camera->format())
                formats_->setCurrentIndex(formats_->count() - 1);
        }
        const auto range = camera->exposureRange();
        exposure_->setEnabled(range.has_value());
        if (range && camera->exposure()) {
            const QSignalBlocker blocker(exposure_);
            exposure_->setValue(static_cast<int>(std::lround(
                kSliderSteps * std::log(*camera->exposure() / range->first) / std::log(range->second / range->first))));
        }
    }
    refresh();
}

void CameraPage::showPicture() {
    picture_->setImage(toImage(scan_.picture()));
    if (scan_.picture().empty())
        return;
    const PictureFigures figures = figuresOf(scan_.picture());
    histogram_->setFigures(figures);
    figures_->setText(tr("Clipped: %1 % bright, %2 % dark.  Sharpness %3 (largest is sharpest)")
                          .arg(100 * figures.bright, 0, 'f', 2)
                          .arg(100 * figures.dark, 0, 'f', 2)
                          .arg(figures.sharpness, 0, 'f', 3));
}

void CameraPage::refresh() {
    const FrameSource* source = workbench_.camera();
    exposureText_->setText(source != nullptr && source->exposure()
                               ? tr("%1 ms").arg(1e3 * *source->exposure(), 0, 'f', 1)
                               : tr("automatic"));
    const auto& camera = workbench_.session().decisions().camera;
    const CameraOrigin& origin = workbench_.session().decisions().cameraOrigin;
    makers_->setEnabled(!camera || origin.kind != CameraOrigin::Kind::Nominal);
    setPrimary(makers_, !camera);
    if (!camera) {
        intrinsics_->setText(tr("<b>Intrinsics are not known yet.</b>"));
        return;
    }
    QString text = tr("<b>Intrinsics</b> for %1 × %2 pixels: focal lengths %3 and %4 px, centre (%5, %6), %7 with %8 "
                      "coefficients.")
                       .arg(camera->width)
                       .arg(camera->height)
                       .arg(camera->fx, 0, 'f', 1)
                       .arg(camera->fy, 0, 'f', 1)
                       .arg(camera->cx, 0, 'f', 1)
                       .arg(camera->cy, 0, 'f', 1)
                       .arg(QString::fromUtf8(name(camera->distortionModel).data()))
                       .arg(camera->distortion.size());
    if (const QString from = sentenceOf(origin); !from.isEmpty())
        text += tr(" They were %1.").arg(from.toHtmlEscaped());
    if (source != nullptr && (source->format().width != camera->width || source->format().height != camera->height))
        text += tr(" <b>The camera gives %1 × %2: choose that size, or other intrinsics.</b>")
                    .arg(source->format().width)
                    .arg(source->format().height);
    intrinsics_->setText(text);
}

}  // namespace skincal
