#pragma once

#include <QByteArray>
#include <QString>
#include <QStringList>
#include <map>
#include <vector>

#include "core/estimation/body_model.h"
#include "core/vision/detection.h"

namespace skincal {

/// A spot that was taken for a module's LED, or came nearest to it, and why.
struct ReportedDetection {
    ModuleId module;
    std::optional<Vector2d> pixel{};       ///< raw (distorted); empty where nothing blinks like it
    double sigma_px = 0;                   ///< 0 where its centre was not told
    std::optional<WordReading> reading{};  ///< where it was decoded from pictures
    QByteArray crops{};                    ///< PNG of the spot lit, dark and the difference; empty where there is none
    bool isRejected = false;               ///< by the operator
    QString whyNot{};                      ///< what spoke against it; empty where it was taken
    std::vector<SpotChoice> choices{};     ///< of which it is the brightest, and the body may take another
};

struct ReportedScan {
    std::string view;
    std::size_t pictures = 0;
    std::vector<ReportedDetection> detections;
    std::vector<ModuleId> unseen{};  ///< out of sight
};

/// What a report says besides what the body itself knows.
struct ReportFacts {
    QString when{};                       ///< it was made, as it shall be printed
    QStringList shortfalls{};             ///< what the data lack
    std::optional<CameraModel> camera{};  ///< that took the pictures
    QString cameraFrom{};                 ///< where its intrinsics come from; empty where nobody knows
    QString skinDevice{};                 ///< by which the data came; empty where nobody knows
    QString cameraDevice{};
    std::size_t poses = 0;                        ///< that count
    QStringList decisions{};                      ///< of the operator, in sentences
    std::map<ModuleId, std::string> uniqueIds{};  ///< of modules that have one
    std::vector<ReportedScan> scans{};            ///< that count
};

/// Everything that makes a calibration traceable, for people: when and by which version, method and devices it was made
/// and from which files, the verdict with its reasons, what the operator decided, quality figures, a table of patches,
/// views and modules with position, standard deviation and what each rests on, and for each detection what decided: the
/// word sent and received, and the spot itself. A page for a browser, without any reference to other files.
[[nodiscard]] QString reportHtml(const BodyModel& body, const ReportFacts& facts);

/// The same on A4 pages with numbers.
[[nodiscard]] QByteArray reportPdf(const BodyModel& body, const ReportFacts& facts);

}  // namespace skincal
