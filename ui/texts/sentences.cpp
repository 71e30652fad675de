#include "ui/texts/sentences.h"

#include <QCoreApplication>

namespace skincal {

QString said(const Sentence& sentence) {
    return QString::fromStdString(sentence.said(
        [](const char* pattern) { return QCoreApplication::translate("skincal::Sentence", pattern).toStdString(); }));
}

QString saidAlone(const Sentence& sentence) {
    QString text = said(sentence);
    if (!text.isEmpty())
        text[0] = text[0].toUpper();
    return text;
}

}  // namespace skincal
