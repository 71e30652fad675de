#include "ui/print/board_pdf.h"

#include <gtest/gtest.h>

#include <QFile>
#include <QGuiApplication>
#include <QImage>
#include <QPainter>
#include <QTemporaryDir>
#include <opencv2/core.hpp>

#include "core/camera_calibration/board_finder.h"

namespace skincal {
namespace {

std::vector<BoardPlan> plans() {
    return {{BoardKind::Chessboard, 9, 6, 0.025, 0, {}},
            {BoardKind::Charuco, 7, 10, 0.024, 0.018, MarkerDictionary::Dict5x5_100},
            {BoardKind::Charuco, 12, 9, 0.06, 0.045, MarkerDictionary::Dict4x4_100}};
}

TEST(BoardPdf, ThePaintedSheetIsABoardOfItsSize) {
    for (const BoardPlan& plan : plans()) {
        const BoardSheet sheet = sheetFor(plan);
        constexpr double kPixelsOfMillimetre = 3;
        QImage image(static_cast<int>(sheet.width_mm * kPixelsOfMillimetre),
                     static_cast<int>(sheet.height_mm * kPixelsOfMillimetre), QImage::Format_Grayscale8);
        image.fill(Qt::white);
        QPainter painter(&image);
        painter.scale(kPixelsOfMillimetre, kPixelsOfMillimetre);
        paintBoard(painter, plan);
        painter.end();
        const cv::Mat picture(image.height(), image.width(), CV_8U, image.bits(),
                              static_cast<std::size_t>(image.bytesPerLine()));
        const auto view = findBoard(picture, plan);
        ASSERT_TRUE(view) << static_cast<int>(view.error().miss);
        ASSERT_EQ(view->corners.size(), static_cast<std::size_t>(plan.cornerCount()));
        EXPECT_NEAR(view->square_px, plan.square * 1000 * kPixelsOfMillimetre, 0.5);
        for (const BoardCorner& corner : view->corners) {
            // A chessboard may be counted from its other end.
            const bool turned = view->corners.front().pixel.y() > view->corners.back().pixel.y();
            const Vector3d p = plan.corner(turned ? plan.cornerCount() - 1 - corner.id : corner.id);
            EXPECT_NEAR(corner.pixel.x() + 0.5, (sheet.left_mm + 1000 * p.x()) * kPixelsOfMillimetre, 1);
            EXPECT_NEAR(corner.pixel.y() + 0.5, (sheet.top_mm + 1000 * p.y()) * kPixelsOfMillimetre, 1);
        }
    }
}

TEST(BoardPdf, EverythingFitsOnItsSheet) {
    for (const BoardPlan& plan : plans()) {
        const BoardSheet sheet = sheetFor(plan);
        EXPECT_GE(sheet.left_mm, 10);
        EXPECT_GE(sheet.top_mm, 10);
        EXPECT_LE(sheet.top_mm + plan.height() * 1000 + 22, sheet.height_mm);
    }
    EXPECT_EQ(sheetFor(plans()[0]).width_mm, 297);
    EXPECT_EQ(sheetFor(plans()[1]).width_mm, 210);
    EXPECT_EQ(sheetFor(plans()[2]).width_mm, 841);
    EXPECT_GT(sheetFor(BoardPlan{BoardKind::Chessboard, 40, 40, 0.1, 0, {}}).width_mm, 4000);
}

TEST(BoardPdf, TheFileHasThePageOfTheSheet) {
    const QTemporaryDir directory;
    const std::string file = directory.filePath("board.pdf").toStdString();
    ASSERT_TRUE(writeBoardPdf(file, plans()[0]));
    QFile written(QString::fromStdString(file));
    ASSERT_TRUE(written.open(QIODevice::ReadOnly));
    const QByteArray bytes = written.readAll();
    EXPECT_TRUE(bytes.startsWith("%PDF-"));
    // A4 across, in points of 1/72 inch.
    const qsizetype at = bytes.indexOf("/MediaBox [");
    ASSERT_GE(at, 0);
    const QList<QByteArray> box = bytes.mid(at + 11, bytes.indexOf(']', at) - at - 11).simplified().split(' ');
    ASSERT_EQ(box.size(), 4);
    EXPECT_NEAR(box[2].toDouble(), 297 / 25.4 * 72, 1);
    EXPECT_NEAR(box[3].toDouble(), 210 / 25.4 * 72, 1);
}

TEST(BoardPdf, WhatCannotBeWrittenIsTold) {
    const auto result = writeBoardPdf("/nonexistent/board.pdf", plans()[0]);
    ASSERT_FALSE(result);
    EXPECT_TRUE(result.error().contains("/nonexistent/board.pdf"));
    EXPECT_THROW((void)writeBoardPdf("a.pdf", BoardPlan{BoardKind::Chessboard, 0, 0, 0, 0, {}}), std::logic_error);
}

}  // namespace
}  // namespace skincal

int main(int argc, char** argv) {
    if (qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM"))
        qputenv("QT_QPA_PLATFORM", "offscreen");
    const QGuiApplication application(argc, argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
