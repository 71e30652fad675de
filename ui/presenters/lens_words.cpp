#include "ui/presenters/lens_words.h"

#include <QCoreApplication>
#include <QDate>

namespace skincal {
namespace {

class LensWords {
    Q_DECLARE_TR_FUNCTIONS(LensWords)
};

QString fromWhere(const CameraOrigin& origin) {
    switch (origin.kind) {
        case CameraOrigin::Kind::File:
            return LensWords::tr("read from %1").arg(QString::fromStdString(origin.file));
        case CameraOrigin::Kind::Calibrated:
            return LensWords::tr("calibrated from %n boards, rms %1 px", nullptr, origin.boards)
                .arg(origin.rms_px, 0, 'f', 2);
        case CameraOrigin::Kind::Nominal:
            return LensWords::tr("given by the camera's maker");
        default:
            return {};
    }
}

}  // namespace

QString sentenceOf(const CameraOrigin& origin) {
    const QString from = fromWhere(origin);
    return from.isEmpty() || origin.date.empty()
               ? from
               : LensWords::tr("%1, on %2").arg(from, QString::fromStdString(origin.date));
}

std::string today() {
    return QDate::currentDate().toString(Qt::ISODate).toStdString();
}

}  // namespace skincal
