#include <gtest/gtest.h>

#include <QApplication>
#include <QFont>
#include <cstdlib>
#include <iostream>

#include "app/headless_display.h"
#include "tests/ui/watchful_application.h"
#include "ui/texts/plural_forms.h"

int main(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    if (GTEST_FLAG_GET(list_tests))
        return RUN_ALL_TESTS();
    // Always on a display of its own: windows do not flicker over somebody's screen, and all draw alike.
    ::unsetenv("DISPLAY");
    const skincal::HeadlessDisplay display;
    if (!display.complaint().empty()) {
        std::cerr << display.complaint() << '\n';
        return 1;
    }
    ::setenv("QT_QPA_PLATFORM", "xcb", 1);
    ::setenv("QT_SCALE_FACTOR", "1", 1);
    QApplication::setStyle("fusion");
    skincal::WatchfulApplication application(argc, argv);
    skincal::installPluralForms(application);
    QFont font("DejaVu Sans");
    font.setPixelSize(12);
    QApplication::setFont(font);
    return RUN_ALL_TESTS();
}
