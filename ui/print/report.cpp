#include "ui/print/report.h"

#include <QAbstractTextDocumentLayout>
#include <QBuffer>
#include <QPainter>
#include <QPdfWriter>
#include <QTextDocument>
#include <algorithm>
#include <cmath>

#include "ui/print/html.h"
#include "ui/print/report_detections.h"
#include "ui/texts/sentences.h"

namespace skincal {
namespace {

using namespace html;

QString list(const QStringList& texts) {
    QString html = QStringLiteral("<ul>\n");
    for (const QString& text : texts)
        html += QStringLiteral("<li>%1</li>\n").arg(text.toHtmlEscaped());
    return html + QStringLiteral("</ul>\n");
}

QString millimetres(double metres) {
    return QString::number(1e3 * metres, 'f', 2);
}

QString origin(const BodyGenerator& generator, const ReportFacts& facts) {
    QString rows = row({ReportText::tr("Program"), escaped(generator.program + " " + generator.version)});
    rows += row({ReportText::tr("Method"), escaped(generator.method)});
    for (const auto& [name, value] : generator.options) {
        // Some writers name it twice.
        if (name != "method")
            rows += row({escaped(name), escaped(value)});
    }
    if (!facts.skinDevice.isEmpty())
        rows += row({ReportText::tr("Skin"), facts.skinDevice.toHtmlEscaped()});
    if (!facts.cameraDevice.isEmpty())
        rows += row({ReportText::tr("Camera"), facts.cameraDevice.toHtmlEscaped()});
    if (facts.poses > 0)
        rows += row({ReportText::tr("Poses"), QString::number(facts.poses)});
    return table({}, rows);
}

QString digests(const std::map<std::string, std::string>& ofFiles) {
    QString rows;
    for (const auto& [file, digest] : ofFiles)
        rows += row({escaped(file), QStringLiteral("<code>%1</code>").arg(escaped(digest))});
    return table({ReportText::tr("File"), ReportText::tr("SHA-256")}, rows);
}

QString figures(const BodyQuality& quality) {
    QString rows = row({ReportText::tr("Modules placed"),
                        ReportText::tr("%1 of %2").arg(quality.modulesPlaced).arg(quality.modulesTotal)});
    const auto add = [&](const QString& name, const std::optional<double>& value, double factor, const QString& unit) {
        if (value)
            rows += row({name, QStringLiteral("%1 %2").arg(factor * *value, 0, 'g', 3).arg(unit)});
    };
    add(ReportText::tr("Reprojection error, rms"), quality.residual_rms_px, 1, ReportText::tr("px"));
    add(ReportText::tr("Ports of neighbours apart, rms"), quality.link_mismatch_rms, 1e3, ReportText::tr("mm"));
    add(ReportText::tr("Ports of neighbours apart, widest"), quality.link_mismatch_max, 1e3, ReportText::tr("mm"));
    add(ReportText::tr("Gravity residual, rms"), quality.gravity_residual_rms, 1, ReportText::tr("m/s²"));
    return table({}, rows);
}

QString camera(const ReportFacts& facts) {
    const CameraModel& c = *facts.camera;
    QString rows = row({ReportText::tr("Pictures"), ReportText::tr("%1 × %2 pixels").arg(c.width).arg(c.height)});
    rows += row(
        {ReportText::tr("Focal lengths"), ReportText::tr("%1 and %2 px").arg(c.fx, 0, 'f', 2).arg(c.fy, 0, 'f', 2)});
    rows += row({ReportText::tr("Centre"), ReportText::tr("%1, %2 px").arg(c.cx, 0, 'f', 2).arg(c.cy, 0, 'f', 2)});
    QStringList coefficients;
    for (const double coefficient : c.distortion)
        coefficients << QString::number(coefficient, 'g', 5);
    rows += row({ReportText::tr("Distortion"),
                 QString::fromUtf8(name(c.distortionModel).data()) + u' ' + coefficients.join(QStringLiteral(", "))});
    rows += row({ReportText::tr("Intrinsics"),
                 facts.cameraFrom.isEmpty() ? ReportText::tr("of unknown origin") : facts.cameraFrom.toHtmlEscaped()});
    return table({}, rows);
}

/// Standard deviations per axis; nothing where a module has none.
struct Sigma {
    std::optional<double> position;  ///< m
    std::optional<double> rotation;  ///< rad
};

Sigma sigmaOf(const BodyModule& module) {
    if (!module.T_body_module || !module.covariance)
        return {};
    return {std::sqrt(module.covariance->bottomRightCorner<3, 3>().trace() / 3),
            std::sqrt(module.covariance->topLeftCorner<3, 3>().trace() / 3)};
}

QString degrees(double radians) {
    return QString::number(radians / kDegree, 'f', 2);
}

/// Median and largest.
QString spreadOf(std::vector<double> sigmas, QString (*write)(double)) {
    if (sigmas.empty())
        return ReportText::tr("–");
    std::sort(sigmas.begin(), sigmas.end());
    return ReportText::tr("%1 (%2)").arg(write(sigmas[sigmas.size() / 2]), write(sigmas.back()));
}

QString patches(const BodyModel& body) {
    QString rows;
    for (const BodyPatch& patch : body.patches) {
        std::vector<double> positions;
        std::vector<double> rotations;
        for (const BodyModule& module : body.modules) {
            const Sigma sigma = sigmaOf(module);
            if (module.patch != patch.id || !sigma.position)
                continue;
            positions.push_back(*sigma.position);
            rotations.push_back(*sigma.rotation);
        }
        rows += row({QString::number(patch.id.value), QString::number(patch.origin.value),
                     QString::number(patch.modules.size()), QString::number(patch.views.size()),
                     spreadOf(std::move(positions), millimetres), spreadOf(std::move(rotations), degrees),
                     said(patch.status).toHtmlEscaped()});
    }
    return table({ReportText::tr("Patch"), ReportText::tr("Origin"), ReportText::tr("Modules"), ReportText::tr("Views"),
                  ReportText::tr("σ, mm"), ReportText::tr("σ, °"), ReportText::tr("Status")},
                 rows);
}

QString views(const BodyModel& body) {
    QString rows;
    for (const BodyView& view : body.views) {
        int used = 0;
        for (const BodyObservation& observation : view.observations)
            used += observation.verdict == ObservationVerdict::Used ? 1 : 0;
        rows += row({escaped(view.name), QString::number(used),
                     view.residual_rms_px ? QString::number(*view.residual_rms_px, 'f', 3) : ReportText::tr("–"),
                     said(view.status).toHtmlEscaped()});
    }
    return table({ReportText::tr("View"), ReportText::tr("Detections used"), ReportText::tr("Residual, px"),
                  ReportText::tr("Status")},
                 rows);
}

QString modules(const BodyModel& body, const ReportFacts& facts) {
    QString rows;
    for (const BodyModule& module : body.modules) {
        QStringList cells{QString::number(module.id.value), escaped(module.type),
                          module.patch ? QString::number(module.patch->value) : ReportText::tr("–")};
        if (module.T_body_module) {
            const Vector3d p = module.T_body_module->translation();
            cells << millimetres(p.x()) << millimetres(p.y()) << millimetres(p.z());
        } else {
            cells << ReportText::tr("–") << ReportText::tr("–") << ReportText::tr("–");
        }
        const Sigma sigma = sigmaOf(module);
        cells << (sigma.position ? millimetres(*sigma.position) : ReportText::tr("–"))
              << (sigma.rotation ? degrees(*sigma.rotation) : ReportText::tr("–"))
              << (!module.T_body_module ? said(module.status).toHtmlEscaped()
                  : module.seen         ? ReportText::tr("pictures")
                                        : ReportText::tr("gravity and links"));
        if (!facts.uniqueIds.empty()) {
            const auto known = facts.uniqueIds.find(module.id);
            cells << (known != facts.uniqueIds.end() ? escaped(known->second) : ReportText::tr("–"));
        }
        rows += row(cells);
    }
    QStringList heads{ReportText::tr("Module"), ReportText::tr("Type"),  ReportText::tr("Patch"),
                      ReportText::tr("x, mm"),  ReportText::tr("y, mm"), ReportText::tr("z, mm"),
                      ReportText::tr("σ, mm"),  ReportText::tr("σ, °"),  ReportText::tr("Rests on")};
    if (!facts.uniqueIds.empty())
        heads << ReportText::tr("Unique id");
    return table(heads, rows);
}

}  // namespace

QString reportHtml(const BodyModel& body, const ReportFacts& facts) {
    QStringList reasons;
    for (const auto* some : {&body.quality.warnings, &body.quality.missing}) {
        for (const Sentence& reason : *some)
            reasons << saidAlone(reason);
    }
    reasons += facts.shortfalls;
    reasons.removeDuplicates();  // the verdict may have named a shortfall
    QString html = QStringLiteral(
                       "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"><title>%1</title>\n"
                       "<style>body { font-family: sans-serif; margin: 2em; } table { border-collapse: "
                       "collapse; } th { text-align: left; }</style></head><body>\n")
                       .arg(ReportText::tr("Calibration of a robot skin"));
    html += QStringLiteral("<h1>%1</h1>\n<p>%2</p>\n")
                .arg(ReportText::tr("Calibration of a robot skin"), facts.when.toHtmlEscaped());
    html += QStringLiteral("<p><b>%1</b></p>\n")
                .arg(ReportText::tr("Verdict: %1").arg(said(sentenceOf(body.quality.trust))));
    html += reasons.empty()
                ? QStringLiteral("<p>%1</p>\n").arg(ReportText::tr("Nothing is missing, and nothing disagrees."))
                : list(reasons);
    if (!facts.decisions.empty())
        html += heading(ReportText::tr("Decided by the operator")) + list(facts.decisions);
    html += heading(ReportText::tr("Made by")) + origin(body.generator, facts);
    if (facts.camera)
        html += heading(ReportText::tr("Camera")) + camera(facts);
    html += heading(ReportText::tr("Quality")) + figures(body.quality);
    html += heading(ReportText::tr("Patches")) +
            QStringLiteral("<p>%1</p>\n")
                .arg(ReportText::tr("σ: of its modules the median one and, in brackets, the largest.")) +
            patches(body) + heading(ReportText::tr("Views")) + views(body);
    html +=
        heading(ReportText::tr("Modules")) +
        QStringLiteral("<p>%1</p>\n")
            .arg(
                ReportText::tr(
                    "Positions in the body frame (%1). σ is one standard deviation per axis, of position and rotation.")
                    .arg(escaped(body.body_frame))) +
        modules(body, facts);
    if (!facts.scans.empty())
        html += detectionsHtml(body, facts.scans);
    if (!body.generator.recording_sha256.empty())
        html += heading(ReportText::tr("Data")) +
                QStringLiteral("<p>%1</p>\n")
                    .arg(ReportText::tr("Of the files as these data are written to a new folder.")) +
                digests(body.generator.recording_sha256);
    return html + QStringLiteral("</body></html>\n");
}

QByteArray reportPdf(const BodyModel& body, const ReportFacts& facts) {
    QByteArray bytes;
    QBuffer buffer(&bytes);
    buffer.open(QIODevice::WriteOnly);
    QPdfWriter writer(&buffer);
    writer.setPageSize(QPageSize(QPageSize::A4));
    writer.setPageMargins(QMarginsF(15, 15, 15, 18), QPageLayout::Millimeter);
    writer.setTitle(ReportText::tr("Calibration of a robot skin"));
    writer.setCreator(QStringLiteral("SkinCal"));
    QTextDocument document;
    QFont font(QStringLiteral("sans-serif"));
    font.setPointSize(9);
    document.setDefaultFont(font);
    document.documentLayout()->setPaintDevice(&writer);
    document.setHtml(reportHtml(body, facts));
    document.setDocumentMargin(0);
    document.setPageSize(QSizeF(writer.width(), writer.height()));
    QPainter painter(&writer);
    for (int page = 0; page < document.pageCount(); ++page) {
        if (page > 0)
            writer.newPage();
        painter.save();
        painter.translate(0, -static_cast<double>(page) * writer.height());
        document.drawContents(&painter,
                              QRectF(0, static_cast<double>(page) * writer.height(), writer.width(), writer.height()));
        painter.restore();
        painter.setFont(font);
        const double line = writer.logicalDpiY() / 6.0;
        painter.drawText(QRectF(0, writer.height() + 0.2 * line, writer.width(), line), Qt::AlignRight,
                         ReportText::tr("%1 of %2").arg(page + 1).arg(document.pageCount()));
    }
    painter.end();
    return bytes;
}

}  // namespace skincal
