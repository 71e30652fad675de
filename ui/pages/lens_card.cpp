#include "ui/pages/lens_card.h"

#include <QComboBox>
#include <QFileDialog>
#include <QLabel>
#include <QVBoxLayout>
#include <QtConcurrent/QtConcurrentRun>

#include "core/formats/files.h"
#include "ui/presenters/board_words.h"
#include "ui/widgets/primary_button.h"

namespace skincal {
namespace {

QString verdictOf(const CameraCalibration& calibration) {
    QStringList reasons;
    for (const CalibrationReason& reason : calibration.reasons)
        reasons << sentenceOf(reason);
    const QString rms = QString::number(calibration.rms_px, 'f', 2);
    return reasons.isEmpty() ? LensCard::tr("<b>%1</b>, rms %2 px.").arg(sentenceOf(calibration.trust), rms)
                             : LensCard::tr("<b>%1</b>, rms %2 px: %3.")
                                   .arg(sentenceOf(calibration.trust), rms, reasons.join(LensCard::tr("; ")));
}

QString tableOf(const std::vector<LensFigure>& figures) {
    QString rows;
    for (const LensFigure& figure : figures) {
        const QString sigma = figure.sigma.isEmpty() ? QString() : LensCard::tr("± %1").arg(figure.sigma);
        rows += QStringLiteral("<tr><td>%1</td><td align=right>%2</td><td align=right>%3</td></tr>")
                    .arg(figure.name, figure.value, sigma);
    }
    return QStringLiteral("<table width=\"100%\" cellpadding=\"2\">%1</table>").arg(rows);
}

}  // namespace

LensCard::LensCard(BoardPresenter& presenter, QWidget* parent)
    : QFrame(parent),
      presenter_(presenter),
      lens_(new QComboBox),
      verdict_(new QLabel),
      figures_(new QLabel),
      use_(new QPushButton(tr("Use this calibration"))),
      save_(new QPushButton(tr("Save as …"))) {
    setObjectName(QStringLiteral("card"));
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(12, 10, 12, 12);
    column->setSpacing(8);
    auto* heading = new QLabel(tr("Lens"));
    heading->setObjectName(QStringLiteral("instruction"));
    column->addWidget(heading);
    lens_->setObjectName(QStringLiteral("lens"));
    lens_->setAccessibleName(tr("Kind of lens"));
    lens_->setToolTip(
        tr("More coefficients than a lens needs make it worse where no board was: take the first that gives small "
           "residuals"));
    lens_->addItem(tr("Ordinary (plumb_bob)"), static_cast<int>(DistortionModel::PlumbBob));
    lens_->addItem(tr("Wide angle (rational)"), static_cast<int>(DistortionModel::RationalPolynomial));
    lens_->addItem(tr("Fisheye (equidistant)"), static_cast<int>(DistortionModel::Equidistant));
    lens_->setCurrentIndex(lens_->findData(static_cast<int>(presenter.lens())));
    column->addWidget(lens_);
    verdict_->setObjectName(QStringLiteral("lensVerdict"));
    verdict_->setWordWrap(true);
    column->addWidget(verdict_);
    figures_->setAccessibleName(tr("Intrinsics and their standard deviations"));
    figures_->setToolTip(tr("Each with one standard deviation, as far as the residuals tell"));
    figures_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    figures_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
    column->addWidget(figures_, 1);
    use_->setObjectName(QStringLiteral("useCalibration"));
    save_->setObjectName(QStringLiteral("saveCalibration"));
    save_->setToolTip(tr("A file for ROS, OpenCV or Kalibr"));
    for (QPushButton* button : {use_, save_}) {
        button->setAutoDefault(false);
        column->addWidget(button);
    }

    connect(lens_, &QComboBox::currentIndexChanged, this,
            [this] { presenter_.setLens(static_cast<DistortionModel>(lens_->currentData().toInt())); });
    connect(use_, &QPushButton::clicked, this, [this] {
        presenter_.accept();
        emit used();
    });
    connect(save_, &QPushButton::clicked, this, &LensCard::chooseSave);
    connect(&presenter, &BoardPresenter::boardsChanged, this, &LensCard::refresh);
    connect(&presenter, &BoardPresenter::calibrationChanged, this, &LensCard::refresh);
    refresh();
}

void LensCard::refresh() {
    const auto& calibration = presenter_.calibration();
    if (calibration) {
        verdict_->setText(verdictOf(*calibration));
        figures_->setText(tableOf(figuresOf(*calibration)));
    } else {
        const QString& failure = presenter_.failure();
        verdict_->setText(!failure.isEmpty() ? failure
                                             : tr("A first result comes with %1 boards, a good one with %2 or more.")
                                                   .arg(BoardPresenter::kLeastBoards)
                                                   .arg(BoardCollectorOptions().views));
        figures_->clear();
    }
    const bool canUse = presenter_.canAccept();
    use_->setEnabled(canUse);
    use_->setToolTip(calibration && calibration->trust == CalibrationTrust::NotToBeTrusted
                         ? tr("Not before it can be trusted: see above what it lacks")
                         : tr("Scans are decoded with these intrinsics from now on; can be undone"));
    save_->setEnabled(calibration != nullptr);
    setPrimary(use_, canUse && presenter_.wish().isEmpty());
}

void LensCard::chooseSave() {
    const QStringList kinds{tr("ROS camera_info (*.yaml)"), tr("OpenCV (*.yml)"), tr("Kalibr camchain (*.yaml)")};
    QString kind = kinds.front();
    const QString file = QFileDialog::getSaveFileName(this, tr("Save the calibration"), QStringLiteral("camera.yaml"),
                                                      kinds.join(QStringLiteral(";;")), &kind);
    if (!file.isEmpty())
        saveAs(file, static_cast<CameraFileKind>(std::max<qsizetype>(0, kinds.indexOf(kind))));
}

void LensCard::saveAs(const QString& file, CameraFileKind kind) {
    if (!presenter_.calibration())
        return;
    const auto text = exportCamera(presenter_.calibration()->camera, kind);
    if (!text) {
        emit told(tr("Kalibr has no such lens: choose another kind of file."), true);
        return;
    }
    QtConcurrent::run([file, text = *text] {
        return writeFileAtomically(file.toStdString(), text);
    }).then(this, [this, file](const tl::expected<void, FileError>& written) {
        if (written)
            emit told(tr("Written: %1").arg(file), false);
        else
            emit told(QString::fromStdString(written.error().message()), true);
    });
}

}  // namespace skincal
