#include "ui/presenters/export_presenter.h"

#include <QDateTime>
#include <QLocale>
#include <QtConcurrent/QtConcurrentRun>
#include <algorithm>

#include "core/formats/body_json.h"
#include "core/formats/export_csv.h"
#include "core/formats/export_ply.h"
#include "core/formats/export_urdf.h"
#include "core/formats/files.h"
#include "ui/presenters/lens_words.h"
#include "ui/presenters/report_facts.h"
#include "ui/texts/sentences.h"

namespace skincal {
namespace {

constexpr std::size_t kMostCrops = 400;

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
         [](const BodyModel& body, const ReportFacts&) { return bodyToJson(body); }, false, true},
        {tr("URDF"), QStringLiteral(".urdf"),
         tr("For robots: a link skin_base (the body frame), a fixed link per patch and per module. Metres and "
            "radians."),
         [](const BodyModel& body, const ReportFacts&) { return exportUrdf(body); }},
        {tr("CSV table"), QStringLiteral(".csv"),
         tr("One row per module: number, type, patch, position (m) and unit quaternion (x y z w) in the body frame."),
         [](const BodyModel& body, const ReportFacts&) { return exportCsv(body); }},
        {tr("PLY mesh"), QStringLiteral(".ply"),
         tr("The outlines of all placed boards as faces with a colour per patch. Metres, body frame."),
         [](const BodyModel& body, const ReportFacts&) { return exportPly(body); }},
        {tr("Report (PDF)"), QStringLiteral(".pdf"),
         tr("For people and files: verdict, reasons, figures, and a table of all modules. Millimetres, body frame."),
         [](const BodyModel& body, const ReportFacts& facts) { return reportPdf(body, facts).toStdString(); }, true,
         true},
        {tr("Report (HTML)"), QStringLiteral(".html"), tr("The same for a browser."),
         [](const BodyModel& body, const ReportFacts& facts) { return reportHtml(body, facts).toStdString(); }, true,
         true},
    };
    pool_.setMaxThreadCount(1);  // one file after the other
    connect(&workbench.session(), &Session::solutionChanged, this, &ExportPresenter::changed);
}

ExportPresenter::~ExportPresenter() {
    isClosing_ = true;
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
        facts.shortfalls << saidAlone(shortfall.text);
    if (solution.measurements->camera.width > 0)
        facts.camera = solution.measurements->camera;
    const Session& session = workbench_.session();
    if (session.isStale())
        facts.shortfalls << tr("The data have changed since: this body is of before the last change");
    if (const int skin = workbench_.chosenSkin(); skin >= 0)
        facts.skinDevice = workbench_.skinOffers.at(static_cast<std::size_t>(skin)).name;
    if (const int camera = workbench_.chosenCamera(); camera >= 0)
        facts.cameraDevice = workbench_.cameraOffers.at(static_cast<std::size_t>(camera)).name;
    // While a newer camera is being solved with, this body is of the one before.
    const Decisions& decisions = session.decisions();
    if (facts.camera && sameCamera(decisions.camera, facts.camera))
        facts.cameraFrom = sentenceOf(decisions.cameraOrigin);
    return facts;
}

std::function<std::string()> ExportPresenter::job(std::size_t format, std::shared_ptr<const Solution> solution,
                                                  bool isPreview) {
    const Session& session = workbench_.session();
    return [this, solution, isPreview, what = formats_.at(format), facts = factsOf(*solution),
            measured = session.measured(), decisions = session.decisions(),
            isData = solution->revision == session.revision()]() mutable {
        RunContext context;
        context.isCancelled = [this, isPreview] { return isPreview && isClosing_; };
        BodyModel body = solution->body;
        const bool areKnown = std::all_of(measured.views.begin(), measured.views.end(), [&](const ScannedView& view) {
            return !view.pictures || digests_.contains(view.pictures);
        });
        std::erase_if(digests_, [&](const auto& known) {
            return std::none_of(measured.views.begin(), measured.views.end(),
                                [&](const ScannedView& view) { return view.pictures == known.first; });
        });
        // What the body does not follow from would be none of its.
        if (isData && what.isTraced && (!isPreview || areKnown)) {
            if (const auto digests = digestSession(measured, decisions, digests_, context))
                body.generator.recording_sha256 = *digests;
        }
        if (what.isReport)
            addData(facts, measured, decisions, isPreview ? 0 : kMostCrops, context);
        return what.bytes(body, facts);
    };
}

void ExportPresenter::preview(std::size_t format, int lines) {
    const std::uint64_t ask = ++asked_;
    const auto placed = solution();
    if (!placed) {
        emit previewed({});
        return;
    }
    auto work = [this, ask, lines, make = job(format, placed, true)] {
        if (ask != asked_)
            return;
        const QString text = beginningOf(make(), lines);
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
    auto work = [this, file, placed, make = job(format, placed, false)] {
        const QString why = complaintOfWriting(file, make);
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
