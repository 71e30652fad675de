// What the Scan step shows of a single module.

#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QTableView>

#include "tests/ui/window/driven_window.h"
#include "ui/presenters/detection_model.h"
#include "ui/widgets/spot_crop.h"

namespace skincal {
namespace {

TEST(SpotCard, ShowsWhereAModuleShouldBeThatWasNotFound) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.capturePoses(5));
    ASSERT_TRUE(driven.useMakersIntrinsics());
    // What one view does not show, another does: then the body knows where it is in the first.
    for (int view = 0; view < 3; ++view) {
        ASSERT_TRUE(driven.scanHere());
        ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
        if (view < 2) {
            ASSERT_TRUE(driven.moveCameraOn());
        }
    }
    auto* table = driven.find<QTableView>("detections");
    auto* views = driven.find<QComboBox>("views");
    const int all = table->model()->rowCount();
    QTest::mouseClick(driven.find<QCheckBox>("needsALook"), Qt::LeftButton, {}, QPoint(8, 8));
    ASSERT_LT(table->model()->rowCount(), all);
    const auto* evidence = driven.find<QLabel>("evidence");
    const auto* fit = driven.find<SpotCrop>("crop4");
    // Where the camera went depends on advice that comes when it comes: any of the views will do.
    int predicted = 0;
    for (int view = views->count() - 1; view > 0 && predicted == 0; --view) {
        views->setCurrentIndex(view);
        for (int row = 0; row < table->model()->rowCount(); ++row) {
            const QModelIndex index = table->model()->index(row, 0);
            table->scrollTo(index);
            QTest::mouseClick(table->viewport(), Qt::LeftButton, {}, table->visualRect(index).center());
            EXPECT_TRUE(evidence->text().contains(index.data().toString()));
            const bool isFound = !fit->isEmpty() && fit->marks().centre;
            if (!isFound && evidence->text().contains("The body has it at") && !fit->isEmpty()) {
                EXPECT_TRUE(fit->marks().predicted);
                if (predicted++ == 0)
                    driven.takePicture(QStringLiteral("scan-needs-a-look"));
            }
        }
    }
    EXPECT_GT(predicted, 0);
    // A found one has both.
    QTest::mouseClick(driven.find<QCheckBox>("needsALook"), Qt::LeftButton, {}, QPoint(8, 8));
    table->sortByColumn(DetectionModel::State, Qt::AscendingOrder);
    table->selectRow(0);
    ASSERT_TRUE(fit->marks().centre && fit->marks().predicted);
    const QPointF apart = *fit->marks().centre - *fit->marks().predicted;
    EXPECT_LT(std::hypot(apart.x(), apart.y()), 0.5);
    EXPECT_GT(fit->marks().width_px, 0.3);
}

TEST(SpotCard, PixelsAreSharpOnFineScreens) {
    SpotCrop crop(QStringLiteral("spot"));
    crop.setFixedSize(64, 64);
    QImage picture(21, 21, QImage::Format_Grayscale8);
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x)
            picture.setPixel(x, y, (x + y) % 2 == 0 ? qRgb(0, 0, 0) : qRgb(255, 255, 255));
    }
    crop.setPicture(picture);
    for (const double ratio : {1.0, 1.5, 2.0}) {
        QImage screen(QSize(64, 64) * ratio, QImage::Format_RGB32);
        screen.setDevicePixelRatio(ratio);
        crop.render(&screen);
        int between = 0;
        for (int y = 6; y < screen.height() - 6; ++y) {
            for (int x = 6; x < screen.width() - 6; ++x) {
                const int level = qGray(screen.pixel(x, y));
                between += level > 0 && level < 255 ? 1 : 0;
            }
        }
        EXPECT_EQ(between, 0) << ratio;
    }
}

}  // namespace
}  // namespace skincal
