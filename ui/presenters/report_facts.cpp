#include "ui/presenters/report_facts.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QImage>
#include <algorithm>
#include <opencv2/core.hpp>

#include "ui/presenters/spot_evidence.h"
#include "ui/texts/sentences.h"

namespace skincal {
namespace {

class ReportWords {
    Q_DECLARE_TR_FUNCTIONS(ReportWords)
};

constexpr int kCropRadius = 12;  // px

/// Lit, dark and the difference side by side.
QByteArray stripOf(const SpotEvidence& evidence) {
    const int gap = 2;
    const int width = evidence.lit.cols;
    QImage strip(3 * width + 2 * gap, evidence.lit.rows, QImage::Format_Grayscale8);
    strip.fill(Qt::white);
    int x = 0;
    for (const cv::Mat* crop : {&evidence.lit, &evidence.dark, &evidence.difference}) {
        cv::Mat into(strip.height(), width, CV_8U, strip.bits() + x, static_cast<std::size_t>(strip.bytesPerLine()));
        crop->copyTo(into);
        x += width + gap;
    }
    QByteArray png;
    QBuffer buffer(&png);
    buffer.open(QIODevice::WriteOnly);
    strip.save(&buffer, "PNG");
    return png;
}

ReportedDetection reportedOf(const Undetected& undetected, bool isRejected) {
    ReportedDetection reported;
    reported.module = undetected.module;
    reported.isRejected = isRejected;
    reported.whyNot = said(undetected.reason);
    reported.choices = undetected.spots;
    if (undetected.nearest) {
        reported.pixel = undetected.nearest->pixel;
        reported.reading = undetected.nearest->reading;
    }
    if (!undetected.spots.empty()) {
        reported.pixel = undetected.spots.front().pixel;
        reported.sigma_px = undetected.spots.front().sigma_px;
    }
    return reported;
}

ReportedScan scanOf(const ScannedView& view, const Decisions& decisions) {
    ReportedScan scan;
    scan.view = view.name;
    scan.pictures = view.frames.size();
    const auto isRejected = [&](ModuleId module) {
        const auto decided = decisions.detections.find({view.name, module});
        return decided != decisions.detections.end() && decided->second.verdict == "rejected";
    };
    for (std::size_t i = 0; i < view.decoded.found.size(); ++i) {
        const LedDetection& found = view.decoded.found[i];
        ReportedDetection detection{found.module, found.pixel, found.sigma_px, {}, {}, false};
        if (i < view.decoded.readings.size())
            detection.reading = view.decoded.readings[i];
        detection.isRejected = isRejected(found.module);
        scan.detections.push_back(std::move(detection));
    }
    for (const Undetected& undetected : view.decoded.undetected) {
        if (!undetected.nearest && undetected.cause == Undetected::Cause::OutOfSight)
            scan.unseen.push_back(undetected.module);
        else
            scan.detections.push_back(reportedOf(undetected, isRejected(undetected.module)));
    }
    std::sort(scan.unseen.begin(), scan.unseen.end());
    std::sort(scan.detections.begin(), scan.detections.end(),
              [](const ReportedDetection& a, const ReportedDetection& b) { return a.module < b.module; });
    return scan;
}

/// In the order in which their crops are worth most: of a kind, those whose lead is least first.
std::vector<std::pair<std::size_t, std::size_t>> byLead(const std::vector<ReportedScan>& scans) {
    std::vector<std::pair<std::size_t, std::size_t>> order;
    for (std::size_t v = 0; v < scans.size(); ++v) {
        for (std::size_t i = 0; i < scans[v].detections.size(); ++i)
            order.emplace_back(v, i);
    }
    // What somebody rejected is what will be asked about, and what was found counts.
    const auto place = [&](const std::pair<std::size_t, std::size_t>& at) {
        const auto& detection = scans[at.first].detections[at.second];
        const int kind = detection.isRejected ? 0 : detection.whyNot.isEmpty() || !detection.choices.empty() ? 1 : 2;
        return std::pair(kind, detection.reading ? detection.reading->margin : 0);
    };
    std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
    return order;
}

QStringList sentencesOf(const Decisions& decisions) {
    QStringList sentences;
    for (const auto& [link, kind] : decisions.links) {
        const QString ends = ReportWords::tr("Link of module %1, port %2, and module %3, port %4: ")
                                 .arg(link.a.value)
                                 .arg(link.a_port)
                                 .arg(link.b.value)
                                 .arg(link.b_port);
        sentences.push_back(ends +
                            (kind == LinkKind::Adjacent ? ReportWords::tr("neighbours") : ReportWords::tr("a cable")));
    }
    for (const int pose : decisions.droppedPoses)
        sentences.push_back(ReportWords::tr("Pose %1 was dropped").arg(pose + 1));
    for (const std::string& view : decisions.droppedViews)
        sentences.push_back(ReportWords::tr("%1 was dropped").arg(QString::fromStdString(view)));
    for (const auto& [key, decision] : decisions.detections) {
        const QString what = decision.verdict == "rejected" ? ReportWords::tr("Module %1 in %2 was rejected")
                                                            : ReportWords::tr("Module %1 in %2 was accepted");
        const QString said = what.arg(key.module.value).arg(QString::fromStdString(key.view));
        sentences.push_back(decision.reason.empty()
                                ? said
                                : ReportWords::tr("%1: %2").arg(said, QString::fromStdString(decision.reason)));
    }
    return sentences;
}

}  // namespace

void addData(ReportFacts& facts, const Measured& measured, const Decisions& decisions, std::size_t mostCrops,
             const RunContext& context) {
    facts.poses = posesOf(measured, decisions).size();
    facts.decisions = sentencesOf(decisions);
    for (const SkinModule& module : measured.skin.modules) {
        if (!module.uniqueId.empty())
            facts.uniqueIds[module.id] = module.uniqueId;
    }
    std::vector<const ScannedView*> views;
    for (const ScannedView& view : measured.views) {
        if (decisions.droppedViews.contains(view.name))
            continue;
        views.push_back(&view);
        facts.scans.push_back(scanOf(view, decisions));
    }
    for (const auto& [v, i] : byLead(facts.scans)) {
        if (mostCrops == 0 || context.isCancelled())
            return;
        ReportedDetection& detection = facts.scans[v].detections[i];
        if (!detection.pixel)
            continue;
        if (const auto evidence = evidenceOf(*views[v], detection.module, *detection.pixel, kCropRadius)) {
            detection.crops = stripOf(*evidence);
            --mostCrops;
        }
    }
}

}  // namespace skincal
