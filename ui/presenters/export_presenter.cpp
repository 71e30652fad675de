#include "ui/presenters/export_presenter.h"

#include <QDateTime>
#include <QLocale>

#include "core/formats/body_json.h"
#include "core/formats/export_csv.h"
#include "core/formats/export_ply.h"
#include "core/formats/export_urdf.h"
#include "core/formats/files.h"
#include "ui/presenters/lens_words.h"

namespace skincal {
namespace {

QString now() {
    return QLocale().toString(QDateTime::currentDateTime(), QLocale::LongFormat);
}

}  // namespace

ExportPresenter::ExportPresenter(Workbench& workbench, QObject* parent) : QObject(parent), workbench_(workbench) {
    formats_ = {
        {tr("Body model"), QStringLiteral(".body.json"),
         tr("Everything: poses with covariances, verdicts on links and detections, quality. Metres, unit quaternions "
            "(x y z w), in the body frame, which is the first placed camera's."),
         [](const Solution& solution) { return bodyToJson(solution.body); }},
        {tr("URDF"), QStringLiteral(".urdf"),
         tr("For robots: a link skin_base (the body frame), a fixed link per patch and per module. Metres and "
            "radians."),
         [](const Solution& solution) { return exportUrdf(solution.body); }},
        {tr("CSV table"), QStringLiteral(".csv"),
         tr("One row per module: number, type, patch, position (m) and unit quaternion (x y z w) in the body frame."),
         [](const Solution& solution) { return exportCsv(solution.body); }},
        {tr("PLY mesh"), QStringLiteral(".ply"),
         tr("The outlines of all placed boards as faces with a colour per patch. Metres, body frame."),
         [](const Solution& solution) { return exportPly(solution.body); }},
        {tr("Report (PDF)"), QStringLiteral(".pdf"),
         tr("For people and files: verdict, reasons, figures, and a table of all modules. Millimetres, body frame."),
         [this](const Solution& solution) { return reportPdf(solution.body, factsOf(solution)).toStdString(); }, true},
        {tr("Report (HTML)"), QStringLiteral(".html"), tr("The same for a browser."),
         [this](const Solution& solution) { return reportHtml(solution.body, factsOf(solution)).toStdString(); }, true},
    };
    connect(&workbench.session(), &Session::solutionChanged, this, &ExportPresenter::changed);
}

const Solution* ExportPresenter::solution() const {
    const auto& solution = workbench_.session().solution();
    return solution && solution->body.quality.modulesPlaced > 0 ? solution.get() : nullptr;
}

const BodyModel* ExportPresenter::body() const {
    const Solution* placed = solution();
    return placed != nullptr ? &placed->body : nullptr;
}

ReportFacts ExportPresenter::factsOf(const Solution& solution) const {
    ReportFacts facts;
    facts.when = now();
    for (const Shortfall& shortfall : solution.shortfalls)
        facts.shortfalls.push_back(shortfall.text);
    if (solution.measurements->camera.width > 0)
        facts.camera = solution.measurements->camera;
    // While a newer camera is being solved with, this body is of the one before.
    const Decisions& decisions = workbench_.session().decisions();
    if (facts.camera && sameCamera(decisions.camera, facts.camera))
        facts.cameraFrom = sentenceOf(decisions.cameraOrigin);
    return facts;
}

QString ExportPresenter::preview(std::size_t format, int lines) const {
    if (body() == nullptr)
        return {};
    const std::string bytes = formats_.at(format).bytes(*solution());
    if (bytes.starts_with("%PDF"))
        return tr("%1 kB of pages for printing.").arg(bytes.size() / 1024);
    const QString text = QString::fromStdString(bytes);
    qsizetype end = 0;
    for (int line = 0; line < lines && end >= 0; ++line) {
        const qsizetype next = text.indexOf(u'\n', end);
        end = next < 0 ? -1 : next + 1;
    }
    return end < 0 || end == text.size() ? text : text.left(end) + QStringLiteral("…");
}

QString ExportPresenter::write(std::size_t format, const std::filesystem::path& file) {
    if (body() == nullptr)
        return tr("There is no placed module to export.");
    const auto result = writeFileAtomically(file, formats_.at(format).bytes(*solution()));
    if (!result)
        return QString::fromStdString(result.error().message());
    emit written(QString::fromStdString(file.string()));
    return {};
}

}  // namespace skincal
