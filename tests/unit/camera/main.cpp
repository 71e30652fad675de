#include <gtest/gtest.h>

#include <QGuiApplication>

#include "tests/fixtures/virtual_camera/virtual_camera.h"

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    const auto folder = skincal::test::prepareVirtualCameras();
    qputenv("QT_QPA_PLATFORM", "offscreen");
    const QGuiApplication app(argc, argv);
    return RUN_ALL_TESTS();
}
