#include "ui/print/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
    placed.status = "placed";
    BodyModule lost;
    lost.id = ModuleId{18};
    lost.type = "hex<script>";
    lost.status = "no view shows it";
    body.modules = {placed, lost};
    body.quality.modulesPlaced = 1;
    body.quality.modulesTotal = 2;
    body.quality.warnings = {"the body shook in pose 3 & more"};
    body.quality.trust = Trust::Usable;
    return body;
}

TEST(Report, TellsWhatMakesACalibrationTraceable) {
    const std::string html = reportHtml(smallBody(), "26 November 2026").toStdString();
    for (const char* text : {"26 November 2026", "1.2.3", "joint", "SHA-256 abc123", "usable", "1 of 2", "100.00",
                             "-20.00", "750.00", "1.00", "no view shows it"})
        EXPECT_THAT(html, HasSubstr(text));
}

TEST(Report, TextFromFilesIsNoMarkup) {
    const std::string html = reportHtml(smallBody(), "now").toStdString();
    EXPECT_THAT(html, HasSubstr("pose 3 &amp; more"));
    EXPECT_THAT(html, HasSubstr("hex&lt;script&gt;"));
    EXPECT_THAT(html, Not(HasSubstr("<script>")));
}

TEST(Report, OfManyModulesHasManyPages) {
    BodyModel body = smallBody();
    const auto pages = [](const QByteArray& pdf) { return pdf.count("/Type /Page\n"); };
    const auto few = pages(reportPdf(body, "now"));
    EXPECT_GE(few, 1);
    body.modules.resize(600, body.modules.front());
    EXPECT_GT(pages(reportPdf(body, "now")), few + 4);
}

}  // namespace
}  // namespace skincal
