#pragma once

#include <QByteArray>
#include <QString>

#include "core/estimation/body_model.h"

namespace skincal {

/// What a report says besides what the body itself knows.
struct ReportFacts {
    QString when;                         ///< it was made, as it shall be printed
    std::vector<std::string> shortfalls;  ///< what the data lack, in sentences
    std::optional<CameraModel> camera;    ///< that took the pictures
    QString cameraFrom;                   ///< where its intrinsics come from; empty where nobody knows
};

/// Everything that makes a calibration traceable, for people: when and by which version and method it was made and from
/// which files, the verdict with its reasons, quality figures, and a table of patches, views and modules with position,
/// standard deviation and what each rests on. A page for a browser, without any reference to other files.
[[nodiscard]] QString reportHtml(const BodyModel& body, const ReportFacts& facts);

/// The same on A4 pages with numbers.
[[nodiscard]] QByteArray reportPdf(const BodyModel& body, const ReportFacts& facts);

}  // namespace skincal
