#include "ui/presenters/export_presenter.h"

#include <QDateTime>
#include <QLocale>
#include <QtConcurrent/QtConcurrentRun>

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

QString beginningOf(const std::string& bytes, int lines) {
    if (bytes.starts_with("%PDF"))
        return ExportPresenter::tr("%1 kB of pages for printing.").arg(bytes.size() / 1024);
    const QString text = QString::fromStdString(bytes);
    qsizetype end = 0;
    for (int line = 0; line < lines && end >= 0; ++line) {
        const qsizetype next = text.indexOf(u'\n', end);
        end = next < 0 ? -1 : next + 1;
    }
    return end < 0 || end == text.size() ? text : text.left(end) + QStringLiteral("…");
}

/// Empty where the file was written. Nobody looks into the job's future: what is thrown is told, too.
QString complaintOfWriting(const std::filesystem::path& file, const std::function<std::string()>& make) {
    try {
        const auto result = writeFileAtomically(file, make());
        return result ? QString() : QString::fromStdString(result.error().message());
    } catch (const std::exception& error) {
        return ExportPresenter::tr("%1 could not be written: %2")
            .arg(QString::fromStdString(file.string()), QString::fromUtf8(error.what()));
    }
}

}  // namespace

ExportPresenter::ExportPresenter(Workbench& workbench, QObject* parent) : QObject(parent), workbench_(workbench) {
    formats_ = {
        {tr("Body model"), QStringLiteral(".body.json"),
         tr("Everything: poses with covariances, verdicts on links and detections, quality. Metres, unit quaternions "
            "(x y z w), in the body frame, which is the first placed camera's."),
         [](const Solution& solution, const ReportFacts&) { return bodyToJson(solution.body); }},
        {tr("URDF"), QStringLiteral(".urdf"),
         tr("For robots: a link skin_base (the body frame), a fixed link per patch and per module. Metres and "
            "radians."),
         [](const Solution& solution, const ReportFacts&) { return exportUrdf(solution.body); }},
        {tr("CSV table"), QStringLiteral(".csv"),
         tr("One row per module: number, type, patch, position (m) and unit quaternion (x y z w) in the body frame."),
         [](const Solution& solution, const ReportFacts&) { return exportCsv(solution.body); }},
        {tr("PLY mesh"), QStringLiteral(".ply"),
         tr("The outlines of all placed boards as faces with a colour per patch. Metres, body frame."),
         [](const Solution& solution, const ReportFacts&) { return exportPly(solution.body); }},
        {tr("Report (PDF)"), QStringLiteral(".pdf"),
         tr("For people and files: verdict, reasons, figures, and a table of all modules. Millimetres, body frame."),
         [](const Solution& solution, const ReportFacts& facts) {
             return reportPdf(solution.body, facts).toStdString();
         },
         true},
        {tr("Report (HTML)"), QStringLiteral(".html"), tr("The same for a browser."),
         [](const Solution& solution, const ReportFacts& facts) {
             return reportHtml(solution.body, facts).toStdString();
         },
         true},
    };
    pool_.setMaxThreadCount(1);  // one file after the other
    connect(&workbench.session(), &Session::solutionChanged, this, &ExportPresenter::changed);
}

ExportPresenter::~ExportPresenter() {
    pool_.waitForDone();
}

std::shared_ptr<const Solution> ExportPresenter::solution() const {
    const auto& solution = workbench_.session().solution();
    return solution && solution->body.quality.modulesPlaced > 0 ? solution : nullptr;
}

const BodyModel* ExportPresenter::body() const {
    const auto placed = solution();
    return placed ? &placed->body : nullptr;  // the session has it
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

void ExportPresenter::preview(std::size_t format, int lines) {
    const std::uint64_t ask = ++asked_;
    const auto placed = solution();
    if (!placed) {
        emit previewed({});
        return;
    }
    auto work = [this, ask, lines, placed, facts = factsOf(*placed), make = formats_.at(format).bytes] {
        const QString text = beginningOf(make(*placed, facts), lines);
        QMetaObject::invokeMethod(
            this,
            [this, ask, text] {
                if (ask == asked_)
                    emit previewed(text);
            },
            Qt::QueuedConnection);
    };
    [[maybe_unused]] const auto future = QtConcurrent::run(&pool_, std::move(work));
}

void ExportPresenter::write(std::size_t format, const std::filesystem::path& file) {
    const auto placed = solution();
    if (!placed) {
        emit failed(tr("There is no placed module to export."));
        return;
    }
    ++writing_;
    auto work = [this, file, placed, facts = factsOf(*placed), make = formats_.at(format).bytes] {
        const QString why = complaintOfWriting(file, [&] { return make(*placed, facts); });
        QMetaObject::invokeMethod(
            this,
            [this, file, placed, why] {
                --writing_;
                if (why.isEmpty())
                    emit written(QString::fromStdString(file.string()), placed);
                else
                    emit failed(why);
            },
            Qt::QueuedConnection);
    };
    [[maybe_unused]] const auto future = QtConcurrent::run(&pool_, std::move(work));
}

}  // namespace skincal
