#pragma once

#include <QByteArray>
#include <QString>

#include "core/estimation/body_model.h"

namespace skincal {

/// Everything that makes a calibration traceable, for people: when and by which version and method it was made and from
/// which files, the verdict with its reasons, quality figures, and a table of patches, views and modules with position,
/// standard deviation and what each rests on. A page for a browser, without any reference to other files.
/// @param when  as it shall be printed.
[[nodiscard]] QString reportHtml(const BodyModel& body, const QString& when);

/// The same on A4 pages with numbers.
[[nodiscard]] QByteArray reportPdf(const BodyModel& body, const QString& when);

}  // namespace skincal
