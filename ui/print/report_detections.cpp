#include "ui/print/report_detections.h"

#include <algorithm>

#include "ui/print/html.h"
#include "ui/texts/sentences.h"
#include "ui/texts/word_lines.h"

namespace skincal {
namespace {

using namespace html;

/// What became of detections in the body, by module.
std::map<ModuleId, const BodyObservation*> observationsOf(const BodyModel& body, const std::string& view) {
    std::map<ModuleId, const BodyObservation*> observations;
    for (const BodyView& solved : body.views) {
        for (const BodyObservation& observation : solved.observations) {
            if (solved.name == view)
                observations[observation.module] = &observation;
        }
    }
    return observations;
}

QString picture(const QByteArray& png) {
    return png.isEmpty()
               ? QString()
               : QStringLiteral("<img src=\"data:image/png;base64,%1\">").arg(QString::fromLatin1(png.toBase64()));
}

QString wordsOf(const WordReading& reading) {
    constexpr int kInALine = 48;
    QStringList lines;
    for (const WordLines& part : linesOf(reading, kInALine))
        lines << part.sent.toHtmlEscaped() << part.received.toHtmlEscaped();
    return QStringLiteral("<code>%1</code>").arg(lines.join(QStringLiteral("<br>")));
}

/// Of a skin that a view sees a part of, most modules are these.
QString unseenModules(const std::vector<ModuleId>& modules) {
    if (modules.empty())
        return {};
    QStringList names;
    for (std::size_t first = 0; first < modules.size();) {
        std::size_t last = first;
        while (last + 1 < modules.size() && modules[last + 1].value == modules[last].value + 1)
            ++last;
        names << (first == last ? QString::number(modules[first].value)
                                : ReportText::tr("%1 to %2").arg(modules[first].value).arg(modules[last].value));
        first = last + 1;
    }
    return QStringLiteral("<p>%1</p>\n")
        .arg(ReportText::tr("Out of sight, nothing blinks like them: %1").arg(names.join(ReportText::tr(", "))));
}

QString placeOf(const ReportedDetection& detection) {
    if (!detection.pixel)
        return ReportText::tr("–");
    // Where no centre was told it is that of the brightest pixel.
    const int digits = detection.sigma_px > 0 ? 2 : 0;
    return ReportText::tr("%1, %2").arg(detection.pixel->x(), 0, 'f', digits).arg(detection.pixel->y(), 0, 'f', digits);
}

/// What is said of the brightest of several spots is not true of another that the body took.
void takeChoice(ReportedDetection& detection, const BodyObservation& observation) {
    const auto taken = std::find_if(detection.choices.begin(), detection.choices.end(), [&](const SpotChoice& choice) {
        return observation.pixel && choice.pixel == *observation.pixel;
    });
    if (taken == detection.choices.end())
        return;
    if (taken != detection.choices.begin())
        detection.crops.clear();
    detection.pixel = taken->pixel;
    detection.sigma_px = taken->sigma_px;
    detection.reading = taken->reading.planes > 0 ? std::optional(taken->reading) : std::nullopt;
}

QString detections(const ReportedScan& scan, const BodyModel& body) {
    const auto observations = observationsOf(body, scan.view);
    QString rows;
    for (ReportedDetection detection : scan.detections) {
        QString verdict = detection.isRejected ? ReportText::tr("rejected") : ReportText::tr("not used");
        if (!detection.whyNot.isEmpty() && !detection.isRejected)
            verdict = ReportText::tr("not found: %1").arg(detection.whyNot.toHtmlEscaped());
        QString residual = ReportText::tr("–");
        if (const auto found = observations.find(detection.module); found != observations.end()) {
            const BodyObservation& observation = *found->second;
            if (observation.verdict == ObservationVerdict::Used) {
                verdict = ReportText::tr("used");
                takeChoice(detection, observation);
            } else if (!detection.isRejected && detection.whyNot.isEmpty() && !observation.reason.empty())
                verdict = said(observation.reason).toHtmlEscaped();
            if (observation.residual)
                residual = QString::number(observation.residual->norm(), 'f', 3);
        }
        QStringList cells{QString::number(detection.module.value), placeOf(detection),
                          detection.sigma_px > 0 ? QString::number(detection.sigma_px, 'f', 3) : ReportText::tr("–"),
                          residual, verdict};
        if (const auto& reading = detection.reading) {
            cells << wordsOf(*reading) << QString::number(reading->snr, 'f', 1)
                  << QString::number(reading->margin, 'f', 0);
        } else {
            cells << ReportText::tr("–") << ReportText::tr("–") << ReportText::tr("–");
        }
        cells << picture(detection.crops);
        rows += row(cells);
    }
    return QStringLiteral("<h3>%1</h3>\n")
               .arg(ReportText::tr("%1: %2 pictures").arg(escaped(scan.view)).arg(scan.pictures)) +
           table({ReportText::tr("Module"), ReportText::tr("Pixel"), ReportText::tr("σ, px"),
                  ReportText::tr("Residual, px"), ReportText::tr("Verdict"), ReportText::tr("Word sent, received"),
                  ReportText::tr("SNR"), ReportText::tr("Lead"), ReportText::tr("Lit, dark, difference")},
                 rows) +
           unseenModules(scan.unseen);
}

}  // namespace

QString detectionsHtml(const BodyModel& body, const std::vector<ReportedScan>& scans) {
    QString html = heading(ReportText::tr("Detections"));
    html += QStringLiteral("<p>%1</p>\n")
                .arg(ReportText::tr(
                    "Every LED blinks a word of its own, 1 lit and 0 dark, picture by picture; a point stands where "
                    "something disturbed it; where LEDs are lit one at a time, the pictures in which it shone. SNR: "
                    "light over noise in one picture. Lead: over whatever else the "
                    "spot could be, −2 log likelihood. Spots of which the lead is least are shown."));
    for (const ReportedScan& scan : scans)
        html += detections(scan, body);
    return html;
}

}  // namespace skincal
