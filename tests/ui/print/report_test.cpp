#include "ui/print/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QBuffer>
#include <QImage>
#include <cmath>

namespace skincal {
namespace {

using testing::HasSubstr;
using testing::Not;

BodyModel smallBody() {
    BodyModel body;
    body.generator.version = "1.2.3";
    body.generator.method = "joint";
    body.generator.recording_sha256["recording.json"] = "abc123";
    BodyModule placed;
    placed.id = ModuleId{17};
    placed.type = "hex";
    placed.patch = PatchId{0};
    placed.T_body_module = makeIsometry(Matrix3d::Identity(), {0.1, -0.02, 0.75});
    placed.covariance = Matrix6d(Matrix6d::Identity() * 1e-6);
    placed.seen = true;
    placed.status = Sentence::saying("placed");
    BodyModule lost;
    lost.id = ModuleId{18};
    lost.type = "hex<script>";
    lost.status = Sentence::verbatim("no view shows it");
    body.modules = {placed, lost};
    body.quality.modulesPlaced = 1;
    body.quality.modulesTotal = 2;
    body.quality.warnings = {Sentence::verbatim("the body shook in pose 3 & more")};
    body.quality.trust = Trust::Usable;
    return body;
}

TEST(Report, TellsWhatMakesACalibrationTraceable) {
    const std::string html = reportHtml(smallBody(), {"26 November 2026"}).toStdString();
    for (const char* text : {"26 November 2026", "1.2.3", "joint", "SHA-256", "abc123", "usable", "1 of 2", "100.00",
                             "-20.00", "750.00", "1.00", "no view shows it"})
        EXPECT_THAT(html, HasSubstr(text));
}

TEST(Report, ListsAllThatIsMissingAndPraisesOnlyWhereNothingIs) {
    BodyModel body = smallBody();
    const char* praise = "Nothing is missing";
    body.quality.warnings.clear();
    EXPECT_THAT(reportHtml(body, {"now"}).toStdString(), HasSubstr(praise));
    const std::string html = reportHtml(body, {"now", {"Patch 2 is seen in one view only"}}).toStdString();
    EXPECT_THAT(html, HasSubstr("Patch 2 is seen in one view only"));
    EXPECT_THAT(html, Not(HasSubstr(praise)));
    body.quality.missing = {Sentence::verbatim("no view shows module 18")};
    EXPECT_THAT(reportHtml(body, {"now"}).toStdString(),
                testing::AllOf(HasSubstr("No view shows module 18"), Not(HasSubstr(praise))));
}

TEST(Report, NamesTheMethodOnce) {
    BodyModel body = smallBody();
    body.generator.options = {{"method", "joint"}, {"misalignment", "2"}};
    const QString html = reportHtml(body, {"now"});
    EXPECT_EQ(html.count("joint"), 1);
    EXPECT_THAT(html.toStdString(), HasSubstr("misalignment"));
}

TEST(Report, TellsHowWellModulesAndPatchesAreKnown) {
    BodyModel body = smallBody();
    BodyPatch patch;
    patch.id = PatchId{0};
    patch.origin = ModuleId{17};
    patch.status = Sentence::saying("placed");
    body.patches = {patch};
    Vector6d variances;
    // 0.5 degrees and 2 mm per axis.
    variances << Vector3d::Constant(std::pow(0.5 * kDegree, 2)), Vector3d::Constant(4e-6);
    BodyModule worse = body.modules.front();
    worse.id = ModuleId{19};
    worse.covariance = Matrix6d(variances.asDiagonal());
    BodyModule better = body.modules.front();
    better.id = ModuleId{20};
    body.modules.push_back(better);
    body.modules.push_back(worse);
    const std::string html = reportHtml(body, {"now"}).toStdString();
    EXPECT_THAT(html, HasSubstr("<td>2.00</td><td>0.50</td>")) << "a module's";
    EXPECT_THAT(html, HasSubstr("<td>1.00 (2.00)</td>")) << "a patch's";
    patch.id = PatchId{1};
    body.patches = {patch};
    EXPECT_THAT(reportHtml(body, {"now"}).toStdString(), HasSubstr("<td>–</td><td>–</td><td>placed</td>"));
}

TEST(Report, SaysWhereTheIntrinsicsComeFrom) {
    CameraModel camera;
    camera.width = 1280;
    camera.height = 720;
    camera.fx = 1100.25;
    camera.distortion = {0.1, -0.05, 0, 0, 0};
    const BodyModel body = smallBody();
    EXPECT_THAT(reportHtml(body, {"now"}).toStdString(), Not(HasSubstr("Intrinsics")));
    EXPECT_THAT(reportHtml(body, {"now", {}, camera, {}}).toStdString(), HasSubstr("unknown origin"));
    EXPECT_THAT(reportHtml(body, {"now", {}, camera, "read from <cam>.yaml"}).toStdString(),
                testing::AllOf(HasSubstr("1280 × 720"), HasSubstr("1100.25"), HasSubstr("-0.05"),
                               HasSubstr("read from &lt;cam&gt;.yaml")));
}

ReportFacts factsWithData(std::size_t detections) {
    ReportFacts facts{"now"};
    facts.skinDevice = "Port <ttyUSB0>";
    facts.cameraDevice = "Webcam C920";
    facts.poses = 6;
    facts.decisions = {"Pose 3 was dropped", "Module 17 in view0 was rejected: a <reflection>"};
    facts.uniqueIds[ModuleId{17}] = "0011aabb";
    ReportedScan scan{"view0", 28, {}};
    QImage crops(75, 25, QImage::Format_Grayscale8);
    crops.fill(Qt::gray);
    QByteArray png;
    QBuffer buffer(&png);
    buffer.open(QIODevice::WriteOnly);
    crops.save(&buffer, "PNG");
    for (std::size_t i = 0; i < detections; ++i)
        scan.detections.push_back({ModuleId{static_cast<std::uint32_t>(17 + i)}, Vector2d(640.25, 360.5), 0.031,
                                   WordReading{4, false, {1, 2}, {1}, {2}, 41.26, 312}, png, i == 0});
    facts.scans = {scan};
    return facts;
}

TEST(Report, ShowsWhatDecidedAndWhoDecidedOtherwise) {
    BodyModel body = smallBody();
    BodyView view;
    view.name = "view0";
    BodyObservation used;
    used.module = ModuleId{18};
    used.residual = Vector2d(0.3, 0.4);
    BodyObservation aside = used;
    aside.module = ModuleId{19};
    aside.verdict = ObservationVerdict::Rejected;
    aside.reason = Sentence::verbatim("9 px from where the body has it");
    view.observations = {used, aside};
    body.views = {view};
    ReportFacts facts = factsWithData(3);
    ReportedDetection near{ModuleId{30}, Vector2d(10, 20), 0, WordReading{4, false, {0, 3}, {0}, {}, 9.5, 3}, {},
                           false};
    near.whyNot = "two <spots> blink its word";
    facts.scans[0].detections.push_back(near);
    facts.scans[0].unseen = {ModuleId{4}, ModuleId{5}, ModuleId{6}, ModuleId{9}};
    const std::string html = reportHtml(body, facts).toStdString();
    for (const char* text : {"not found: two &lt;spots&gt; blink its word",
                             "1001<br>1000",
                             "<td>9.5</td>",
                             "4 to 6, 9",
                             "<td>10, 20</td>",
                             "Port &lt;ttyUSB0&gt;",
                             "Webcam C920",
                             "Pose 3 was dropped",
                             "a &lt;reflection&gt;",
                             "0011aabb",
                             "28 pictures",
                             "640.25, 360.50",
                             "0.031",
                             "0110<br>01.0",
                             "41.3",
                             "312",
                             "<td>rejected</td>",
                             "<td>0.500</td><td>used</td>",
                             "9 px from where the body has it",
                             "<img src=\"data:image/png;base64,"})
        EXPECT_THAT(html, HasSubstr(text));
    const std::string without = reportHtml(body, {"now"}).toStdString();
    for (const char* text : {"Decided by the operator", "Detections</h2>", "Unique id", "<img"})
        EXPECT_THAT(without, Not(HasSubstr(text)));
}

TEST(Report, PagesHaveThePicturesOfSpots) {
    const BodyModel body = smallBody();
    const auto images = [](const QByteArray& pdf) { return pdf.count("/Subtype /Image"); };
    EXPECT_EQ(images(reportPdf(body, {"now"})), 0);
    EXPECT_GT(images(reportPdf(body, factsWithData(2))), 0);
}

TEST(Report, TextFromFilesIsNoMarkup) {
    const std::string html = reportHtml(smallBody(), {"now"}).toStdString();
    EXPECT_THAT(html, HasSubstr("pose 3 &amp; more"));
    EXPECT_THAT(html, HasSubstr("hex&lt;script&gt;"));
    EXPECT_THAT(html, Not(HasSubstr("<script>")));
}

TEST(Report, OfManyModulesHasManyPages) {
    BodyModel body = smallBody();
    const auto pages = [](const QByteArray& pdf) { return pdf.count("/Type /Page\n"); };
    const auto few = pages(reportPdf(body, {"now"}));
    EXPECT_GE(few, 1);
    body.modules.resize(600, body.modules.front());
    EXPECT_GT(pages(reportPdf(body, {"now"})), few + 4);
}

}  // namespace
}  // namespace skincal
