#include "ui/texts/plural_forms.h"

#include <QCoreApplication>
#include <QTranslator>
#include <stdexcept>

// Outside of all namespaces, as its macro asks. In a static library nobody else calls it.
static void initTexts() {
    Q_INIT_RESOURCE(texts);
}

namespace skincal {

void installPluralForms(QCoreApplication& application) {
    initTexts();
    auto* translator = new QTranslator(&application);
    if (!translator->load(QStringLiteral(":/texts/skincal_en.qm")))
        throw std::logic_error("the plural forms are not part of the program");
    QCoreApplication::installTranslator(translator);
}

}  // namespace skincal
