#include "ui/texts/word_lines.h"

#include <QCoreApplication>
#include <QStringList>
#include <algorithm>
#include <array>

namespace skincal {
namespace {

class WordText {
    Q_DECLARE_TR_FUNCTIONS(WordText)
};

QString pictureOfPlane(const WordReading& reading, std::uint32_t plane) {
    if (!reading.coloured)
        return QString::number(plane + 1);
    const std::array names{WordText::tr("blue"), WordText::tr("green"), WordText::tr("red")};
    return WordText::tr("%1 (%2)").arg(plane / 3 + 1).arg(names.at(plane % 3));
}

/// The first few of them.
QString picturesOf(const WordReading& reading, const std::vector<std::uint32_t>& planes) {
    constexpr std::size_t kMost = 9;
    QStringList pictures;
    for (std::size_t i = 0; i < std::min(kMost, planes.size()); ++i)
        pictures.push_back(pictureOfPlane(reading, planes[i]));
    if (pictures.isEmpty())
        return WordText::tr("in no picture");
    if (planes.size() > kMost)
        pictures.push_back(WordText::tr("…"));
    return WordText::tr("in picture %1").arg(pictures.join(WordText::tr(", ")));
}

}  // namespace

std::vector<WordLines> linesOf(const WordReading& reading, int width) {
    constexpr std::size_t kFew = 9;  // in colours: one in white, the three primaries, its own
    if (reading.planes > static_cast<std::size_t>(width) && reading.sent.size() <= kFew) {
        QString received = picturesOf(reading, reading.received);
        if (!reading.disturbed.empty())
            received = WordText::tr("%1; %2 disturbed").arg(received).arg(reading.disturbed.size());
        return {{picturesOf(reading, reading.sent), received}};
    }
    const QString sent = QString::fromStdString(reading.sentBits());
    const QString received = QString::fromStdString(reading.receivedBits());
    std::vector<WordLines> lines;
    for (int i = 0; i < sent.size(); i += width)
        lines.push_back({sent.mid(i, width), received.mid(i, width)});
    return lines;
}

}  // namespace skincal
