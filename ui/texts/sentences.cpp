#include "ui/texts/sentences.h"

#include <QCoreApplication>
#include <algorithm>

namespace skincal {

QString said(const Sentence& sentence) {
    return QString::fromStdString(sentence.said(
        [](const char* pattern) { return QCoreApplication::translate("skincal::Sentence", pattern).toStdString(); }));
}

QString saidAlone(const Sentence& sentence) {
    return capitalised(said(sentence));
}

QString capitalised(QString text) {
    const auto end = std::find_if(text.cbegin(), text.cend(), [](QChar c) { return c.isSpace(); });
    const bool isWord = std::all_of(
        text.cbegin(), end, [](QChar c) { return c.isLower() || c == u'\'' || c == u'’' || c == u'-' || c == u','; });
    if (isWord && !text.isEmpty())
        text[0] = text[0].toUpper();
    return text;
}

}  // namespace skincal
