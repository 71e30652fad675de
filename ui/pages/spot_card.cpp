#include "ui/pages/spot_card.h"

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <algorithm>

#include "ui/pages/page.h"
#include "ui/presenters/detection_model.h"
#include "ui/presenters/spot_evidence.h"
#include "ui/texts/word_lines.h"
#include "ui/widgets/image_conversion.h"
#include "ui/widgets/spot_crop.h"

namespace skincal {
namespace {

constexpr int kSmallest = 64;  // on the screen
constexpr int kLargest = 128;
constexpr int kButtons = 96;

/// Where to look: its spot; the brightest of several; what came nearest to being it; or where the body has it.
std::optional<Vector2d> placeOf(const ScannedView& view, const DetectionRow& detection, const OverlayModule* byBody) {
    if (detection.pixel)
        return detection.pixel;
    std::optional<Vector2d> nearest;
    for (const Undetected& undetected : view.decoded.undetected) {
        if (undetected.module != detection.module)
            continue;
        if (!undetected.spots.empty())
            return undetected.spots.front().pixel;
        if (undetected.nearest)
            nearest = undetected.nearest->pixel;
    }
    return nearest || byBody == nullptr ? nearest : std::optional(byBody->led);
}

QString wordsBelowEachOther(const WordReading& reading) {
    constexpr int kInALine = 64;
    QString text;
    for (const WordLines& lines : linesOf(reading, kInALine))
        text += QLatin1String("\n") + SpotCard::tr("sent %1\nseen %2").arg(lines.sent, lines.received);
    return text;
}

/// @param isFound  else the lead is not what it lacks
QString strengthOf(const WordReading& reading, bool isFound) {
    const QString light = SpotCard::tr("Light %1 times its noise").arg(reading.snr, 0, 'f', 0);
    if (!isFound && reading.margin > 0)
        return SpotCard::tr("%1; ahead of other words by %2").arg(light).arg(reading.margin, 0, 'f', 0);
    return reading.margin > 0 ? SpotCard::tr("%1; ahead of whatever else it could be by %2 (20 is enough)")
                                    .arg(light)
                                    .arg(reading.margin, 0, 'f', 0)
                              : SpotCard::tr("%1; something else is as likely").arg(light);
}

QString placeWords(const OverlayModule& byBody) {
    const QString at = QStringLiteral("(%1, %2)").arg(byBody.led.x(), 0, 'f', 1).arg(byBody.led.y(), 0, 'f', 1);
    switch (byBody.sight) {
        case OverlayModule::Sight::TurnedAway:
            return SpotCard::tr("The body has it at %1 px, turned away from the camera.").arg(at);
        case OverlayModule::Sight::Behind:
            return SpotCard::tr("The body has it at %1 px, behind another module.").arg(at);
        default:
            return SpotCard::tr("The body has it at %1 px, in the open.").arg(at);
    }
}

QString wordsOf(const DetectionRow& detection, const OverlayModule* byBody,
                const std::optional<SpotEvidence>& evidence) {
    QString text = SpotCard::tr("Module %1: %2").arg(detection.module.value).arg(nameOf(detection.state));
    if (detection.pixel) {
        text +=
            SpotCard::tr(" at (%1, %2) px").arg(detection.pixel->x(), 0, 'f', 2).arg(detection.pixel->y(), 0, 'f', 2);
        if (byBody != nullptr)
            text += SpotCard::tr(", %1 px off the body").arg((*detection.pixel - byBody->led).norm(), 0, 'f', 3);
    }
    if (evidence)
        text += SpotCard::tr(", %1 grey levels of light").arg(evidence->contrast, 0, 'f', 0);
    if (!detection.reason.isEmpty())
        text += SpotCard::tr("; %1").arg(detection.reason);
    if (!detection.pixel && byBody != nullptr)
        text += QLatin1String("\n") + placeWords(*byBody);
    if (detection.reading) {
        text += QLatin1String("\n") + strengthOf(*detection.reading, detection.pixel.has_value()) +
                wordsBelowEachOther(*detection.reading);
    }
    return text;
}

}  // namespace

SpotCard::SpotCard(Workbench& workbench, QWidget* parent)
    : QWidget(parent), workbench_(workbench), buttons_(new QVBoxLayout), text_(mutedLabel()) {
    const std::array<QString, Crops> names{tr("lit"), tr("dark"), tr("difference"), tr("threshold"), tr("fit")};
    const std::array<QString, Crops> why{
        tr("Mean of the pictures in which its LED was on, around its spot"),
        tr("Mean of the pictures in which its LED was off: what else shines or mirrors there"),
        tr("Lit minus dark, stretched to full contrast: the light of this LED alone. One round spot is right; a second "
           "one, or a streak, is a reflection."),
        tr("What of the blurred difference exceeds half its maximum, as the paper's detector takes it. One compact "
           "piece is right; several mean noise or other light."),
        tr("The difference with what was fitted. Blue cross: centre of the spot; blue circle: its width (one sigma); "
           "orange diamond: where the body has the LED. Cross and diamond apart mean a wrong spot or a wrong body.")};
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(4);
    grid->setVerticalSpacing(2);
    for (int i = 0; i < Crops; ++i) {
        auto* crop = new SpotCrop(names.at(static_cast<std::size_t>(i)));
        crop->setObjectName(QStringLiteral("crop%1").arg(i));
        crop->setToolTip(why.at(static_cast<std::size_t>(i)));
        crop->setAccessibleDescription(why.at(static_cast<std::size_t>(i)));
        crop->setFixedSize(kSmallest, kSmallest);
        crops_.at(static_cast<std::size_t>(i)) = crop;
        grid->addWidget(crop, 0, i);
        auto* name = mutedLabel(names.at(static_cast<std::size_t>(i)));
        name->setAlignment(Qt::AlignCenter);
        name->setWordWrap(false);
        name->setToolTip(why.at(static_cast<std::size_t>(i)));
        grid->addWidget(name, 1, i);
    }
    grid->setColumnStretch(Crops, 1);
    buttons_->addStretch();
    grid->addLayout(buttons_, 0, Crops + 1, 2, 1);
    text_->setObjectName(QStringLiteral("evidence"));
    text_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
    grid->addWidget(text_, 2, 0, 1, Crops + 2);
}

void SpotCard::addButton(QPushButton& button) {
    buttons_->insertWidget(buttons_->count() - 1, &button);
}

void SpotCard::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    // As large as the page has room for.
    const int side = std::clamp((width() - kButtons) / Crops - 4, kSmallest, kLargest);
    for (SpotCrop* crop : crops_)
        crop->setFixedSize(side, side);
}

void SpotCard::showNothing(const QString& why) {
    for (SpotCrop* crop : crops_)
        crop->clear();
    text_->setText(why);
}

void SpotCard::showDetection(const std::string& name, const DetectionRow& detection) {
    showNothing({});
    const ScannedView* view = workbench_.session().findView(name);
    if (view == nullptr)
        return;
    const auto byBody = placeByBody(workbench_.session(), name, detection.module);
    const OverlayModule* predicted = byBody ? &*byBody : nullptr;
    const auto place = placeOf(*view, detection, predicted);
    const auto evidence = place ? evidenceOf(*view, detection.module, *place) : std::nullopt;
    if (evidence)
        showCrops(*evidence, detection, predicted);
    QString text = wordsOf(detection, predicted, evidence);
    if (place && (!view->pictures || view->pictures->empty()))
        text += QLatin1String("\n") + tr("This view was recorded without pictures.");
    text_->setText(text);
}

void SpotCard::showCrops(const SpotEvidence& evidence, const DetectionRow& detection, const OverlayModule* byBody) {
    const std::array pictures{evidence.lit, evidence.dark, evidence.difference, evidence.threshold,
                              evidence.difference};
    for (std::size_t i = 0; i < pictures.size(); ++i)
        crops_.at(i)->setPicture(toImage(pictures.at(i)));
    const auto inCrop = [&](const Vector2d& pixel) {
        return QPointF(pixel.x() - evidence.corner.x, pixel.y() - evidence.corner.y);
    };
    SpotCrop::Marks marks;
    if (detection.pixel) {
        marks.centre = inCrop(*detection.pixel);
        marks.width_px = evidence.width_px.value_or(0);
    }
    if (byBody != nullptr)
        marks.predicted = inCrop(byBody->led);
    crops_[Fit]->setMarks(marks);
}

}  // namespace skincal
