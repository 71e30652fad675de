#include <gtest/gtest.h>

#include <QGuiApplication>

#include "ui/texts/plural_forms.h"

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    qputenv("QT_QPA_PLATFORM", "offscreen");
    QGuiApplication app(argc, argv);
    skincal::installPluralForms(app);
    return RUN_ALL_TESTS();
}
