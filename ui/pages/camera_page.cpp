#include "ui/pages/camera_page.h"

#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QPushButton>
#include <QSlider>
#include <QtConcurrent/QtConcurrentRun>
#include <algorithm>
#include <cmath>

#include "core/camera/media_source.h"
#include "core/formats/camera_file.h"
#include "ui/pages/calibration_dialog.h"
#include "ui/pages/video_dialog.h"
#include "ui/presenters/camera_words.h"
#include "ui/presenters/lens_words.h"
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
      controls_(mutedLabel()),
      intrinsics_(new QLabel),
      load_(new QPushButton(tr("Load …"))),
      makers_(new QPushButton(tr("Use the maker's intrinsics"))),
      calibrate_(new QPushButton(tr("Calibrate here …"))) {
    auto* top = new QHBoxLayout;
    devices_->setAccessibleName(tr("Camera"));
    devices_->setToolTip(tr("The camera that looks at the body"));
    devices_->setObjectName(QStringLiteral("cameras"));
    for (QComboBox* box : {devices_, formats_}) {
        box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
        box->setMinimumContentsLength(kShownLetters);
    }
    formats_->setObjectName(QStringLiteral("resolutions"));
    formats_->setAccessibleName(tr("Resolution"));
    formats_->setToolTip(tr("Size and rate of the pictures; intrinsics hold for one size"));
    exposure_->setRange(0, kSliderSteps);
    exposure_->setObjectName(QStringLiteral("exposure"));
    exposure_->setAccessibleName(tr("Exposure"));
    exposure_->setToolTip(tr("Shorten it until LEDs are bright and not clipped"));
    top->addWidget(devices_, 4);
    top->addWidget(formats_, 4);
    top->addWidget(new QLabel(tr("Exposure")));
    exposure_->setMinimumWidth(60);
    top->addWidget(exposure_, 1);
    exposureText_->setMinimumWidth(64);
    top->addWidget(exposureText_);
    body().addLayout(top);
    showPlaceholder();
    body().addWidget(picture_, 1);
    body().addWidget(figures_);
    auto* below = new QHBoxLayout;
    below->addWidget(histogram_, 1);
    auto* right = new QVBoxLayout;
    intrinsics_->setObjectName(QStringLiteral("intrinsics"));
    intrinsics_->setWordWrap(true);
    right->addWidget(intrinsics_);
    controls_->setObjectName(QStringLiteral("controls"));
    controls_->setWordWrap(true);
    right->addWidget(mutedLabel(tr("Reads ROS camera_info YAML, OpenCV YAML or XML, and Kalibr camchain YAML.")));
    auto* buttons = new QHBoxLayout;
    load_->setObjectName(QStringLiteral("loadIntrinsics"));
    load_->setToolTip(tr("A file with focal lengths, centre and distortion of this camera at this size"));
    makers_->setObjectName(QStringLiteral("makersIntrinsics"));
    makers_->setToolTip(tr("The simulated camera knows its own lens"));
    calibrate_->setObjectName(QStringLiteral("calibrateHere"));
    calibrate_->setToolTip(tr("Show a printed chessboard or ChArUco board to this camera and get its intrinsics"));
    buttons->addWidget(makers_);
    buttons->addWidget(calibrate_);
    buttons->addWidget(load_);
    buttons->addStretch();
    right->addWidget(controls_);
    right->addStretch();
    below->addLayout(right, 2);
    body().addLayout(below);
    // Not beside the histogram: three buttons are wide.
    body().addLayout(buttons);

    connect(devices_, &QComboBox::activated, this, &CameraPage::chooseDevice);
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
    connect(&workbench, &Workbench::cameraOffersChanged, this, &CameraPage::listDevices);
    connect(&workbench, &Workbench::cameraChosen, this, [this] {
        connect(workbench_.camera(), &FrameSource::abilitiesChanged, this, &CameraPage::listFormats);
        showPlaceholder();
        listFormats();
    });
    connect(&workbench.session(), &Session::decisionsChanged, this, &CameraPage::refresh);
    connect(&scan, &ScanPresenter::pictureChanged, this, [this] {
        if (isActive_)
            showPicture();
    });
    connect(&scan, &ScanPresenter::cameraFailed, this, [this](const QString& why) {
        picture_->setPlaceholder(why);
        refresh();
    });
    listDevices();
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
    const int load = ++loads_;
    QtConcurrent::run([file] {
        return readCameraModel(file.toStdString());
    }).then(this, [this, file, load](const tl::expected<CameraModel, FileError>& camera) {
        if (load != loads_)
            return;  // another was chosen while this one was read
        if (!camera) {
            emit failed(QString::fromStdString(camera.error().message()));
            return;
        }
        CameraOrigin origin;
        origin.kind = CameraOrigin::Kind::File;
        origin.file = QFileInfo(file).fileName().toStdString();
        adopt(*camera, std::move(origin), tr("Load intrinsics"));
    });
}

void CameraPage::adopt(const CameraModel& camera, CameraOrigin origin, const QString& text) {
    origin.date = today();
    workbench_.session().decide(text, [&](Decisions& decisions) {
        decisions.camera = camera;
        decisions.cameraOrigin = std::move(origin);
    });
}

void CameraPage::listDevices() {
    devices_->clear();
    for (const auto& offer : workbench_.cameraOffers) {
        devices_->addItem(offer.name);
        devices_->setItemData(devices_->count() - 1, offer.description, Qt::ToolTipRole);
    }
    devices_->insertSeparator(devices_->count());
    devices_->addItem(tr("Video file or stream …"));
    devices_->setItemData(devices_->count() - 1, tr("Takes pictures from a video or a camera in the network"),
                          Qt::ToolTipRole);
    listFormats();
}

void CameraPage::showPlaceholder() {
    picture_->setPlaceholder(tr("The camera's picture appears here."));
}

void CameraPage::chooseDevice(int offer) {
    if (offer >= static_cast<int>(workbench_.cameraOffers.size())) {
        devices_->setCurrentIndex(workbench_.chosenCamera());
        askForVideo();
    } else if (offer != workbench_.chosenCamera()) {
        workbench_.chooseCamera(static_cast<std::size_t>(offer));
    } else {
        // One that failed is tried again.
        scan_.setActive(isActive_);
    }
}

void CameraPage::askForVideo() {
    auto* dialog = new VideoDialog(this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, this, [this, dialog] {
        if (const auto url = dialog->url())
            openVideo(*url);
    });
    dialog->open();
}

void CameraPage::openVideo(const QUrl& url) {
    const QString key = QStringLiteral("video:") + url.toString();
    auto offers = workbench_.cameraOffers;
    const auto known = std::find_if(offers.begin(), offers.end(), [&](const auto& offer) { return offer.key == key; });
    const auto index = static_cast<std::size_t>(known - offers.begin());
    if (known == offers.end()) {
        offers.push_back({MediaSource(url).name(), url.toDisplayString(QUrl::RemoveUserInfo | QUrl::PreferLocalFile),
                          [url] { return std::make_unique<MediaSource>(url); }, key});
        workbench_.setCameraOffers(std::move(offers));
    }
    chooseDevice(static_cast<int>(index));
}

void CameraPage::listFormats() {
    formats_->clear();
    if (const FrameSource* camera = workbench_.camera()) {
        devices_->setCurrentIndex(workbench_.chosenCamera());
        for (const FrameFormat& format : camera->formats()) {
            // Rates such as 29.97 are to be read, not to be computed with.
            const QString rate = QString::number(std::round(100 * format.framesPerSecond) / 100);
            formats_->addItem(format.framesPerSecond > 0
                                  ? tr("%1 × %2, %3 /s").arg(format.width).arg(format.height).arg(rate)
                                  : tr("%1 × %2").arg(format.width).arg(format.height));
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
    showNotes();
    const PictureFigures figures = figuresOf(scan_.picture());
    histogram_->setFigures(figures);
    figures_->setText(tr("Clipped: %1 % bright, %2 % dark.  Sharpness %3 (largest is sharpest)")
                          .arg(100 * figures.bright, 0, 'f', 2)
                          .arg(100 * figures.dark, 0, 'f', 2)
                          .arg(figures.sharpness, 0, 'f', 3));
}

void CameraPage::showNotes() {
    const FrameSource* source = workbench_.camera();
    QStringList notes;
    if (source != nullptr)
        notes = {controlWords(source->controls()), refusedWords(source->refused())};
    notes.removeAll(QString());
    controls_->setText(notes.join(QLatin1Char(' ')));
    controls_->setVisible(!notes.isEmpty());
}

void CameraPage::refresh() {
    const FrameSource* source = workbench_.camera();
    showNotes();
    formats_->setEnabled(formats_->count() > 0);
    exposureText_->setText(source != nullptr && source->exposure()
                               ? tr("%1 ms").arg(1e3 * *source->exposure(), 0, 'f', 1)
                               : tr("automatic"));
    const auto& camera = workbench_.session().decisions().camera;
    // Those of a rig never go, and have no key.
    const int chosen = workbench_.chosenCamera();
    makers_->setVisible(workbench_.hands && workbench_.hands->intrinsics &&
                        (chosen < 0 || workbench_.cameraOffers.at(static_cast<std::size_t>(chosen)).key.isEmpty()));
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
    if (source != nullptr && source->format().width > 0 &&
        (source->format().width != camera->width || source->format().height != camera->height))
        text += tr(" <b>The camera gives %1 × %2: choose that size, or other intrinsics.</b>")
                    .arg(source->format().width)
                    .arg(source->format().height);
    intrinsics_->setText(text);
}

}  // namespace skincal
