#include "ui/presenters/mesh_presenter.h"

#include <QFileInfo>
#include <QtConcurrent/QtConcurrentRun>
#include <new>

#include "core/formats/stl_file.h"

namespace skincal {
MeshPresenter::MeshPresenter(Workbench& workbench, QObject* parent)
    : QObject(parent),
      workbench_(workbench),
      cancelled_(std::make_shared<std::atomic<bool>>(false)),
      forgotten_(std::make_shared<std::atomic<bool>>(false)) {
    pool_.setMaxThreadCount(1);
    connect(&watcher_, &QFutureWatcherBase::finished, this, &MeshPresenter::finish);
    connect(&workbench.session(), &Session::solutionChanged, this, [this] {
        if (!hasMesh())
            return;
        // What is shown stays until there is better: the mesh does not flicker with every decision.
        const auto shown = placedModules().empty() ? nullptr : comparison_;
        compareSoon(shown);
    });
}

MeshPresenter::~MeshPresenter() {
    *cancelled_ = true;
    *forgotten_ = true;
    watcher_.disconnect(this);
    pool_.waitForDone();
}

bool MeshPresenter::hasSimulatedBody() const {
    return workbench_.hands && workbench_.hands->bodySurface;
}

void MeshPresenter::begin(const QString& name) {
    remove();
    name_ = name;
}

void MeshPresenter::open(const QString& file) {
    begin(QFileInfo(file).fileName());
    file_ = file.toStdString();
    compareSoon();
}

void MeshPresenter::useSimulatedBody() {
    if (!hasSimulatedBody())
        return;
    begin(tr("simulated body"));
    raw_ = std::make_shared<const TriangleMesh>(workbench_.hands->bodySurface());
    compareSoon();
}

void MeshPresenter::remove() {
    *cancelled_ = true;
    *forgotten_ = true;
    forgotten_ = std::make_shared<std::atomic<bool>>(false);
    ++run_;
    isDue_ = false;
    name_.clear();
    file_.clear();
    complaint_.clear();
    raw_.reset();
    mesh_.reset();
    comparison_.reset();
    emit changed();
}

void MeshPresenter::setUnit(std::optional<MeshUnit> unit) {
    if (unit == unit_)
        return;
    unit_ = unit;
    if (hasMesh())
        compareSoon();
}

void MeshPresenter::setOffsetFitted(bool fitted) {
    if (fitted == isOffsetFitted_)
        return;
    isOffsetFitted_ = fitted;
    if (hasMesh())
        compareSoon();
}

void MeshPresenter::setActive(bool active) {
    isActive_ = active;
    if (active && isDue_) {
        start();
    } else if (!active && isBusy() && !comparison_) {
        isDue_ = true;
        *cancelled_ = true;
    }
}

void MeshPresenter::compareSoon(std::shared_ptr<const MeshComparison> meanwhile) {
    isDue_ = true;
    ++run_;
    *cancelled_ = true;
    comparison_ = std::move(meanwhile);
    complaint_.clear();
    if (isWanted())
        start();
    emit changed();
}

std::vector<PlacedModule> MeshPresenter::placedModules() const {
    std::vector<PlacedModule> modules;
    if (const auto& solution = workbench_.session().solution()) {
        for (const BodyModule& module : solution->body.modules) {
            if (module.T_body_module)
                modules.push_back({module.id, *module.T_body_module});
        }
    }
    return modules;
}

MeshPresenter::Outcome MeshPresenter::compare(const Request& request) {
    Outcome outcome{request.run, request.forgotten, request.raw, nullptr, MeshUnit::Metre, nullptr, {}};
    // What has been read so far would be for nothing: only a mesh that nobody wants any more is read half.
    RunContext reading;
    reading.isCancelled = [&] { return request.forgotten->load(); };
    RunContext comparing;
    comparing.isCancelled = [&] { return request.cancelled->load(); };
    try {
        if (!outcome.raw) {
            auto mesh = readStl(request.file, reading);
            if (!mesh) {
                outcome.complaint =
                    tr("This mesh can't be read: %1").arg(QString::fromStdString(mesh.error().message()));
                return outcome;
            }
            outcome.raw = std::make_shared<const TriangleMesh>(*std::move(mesh));
        }
        if (comparing.isCancelled())
            return outcome;
        outcome.unit = request.unit.value_or(likelyUnit(request.modules, *outcome.raw));
        outcome.mesh = std::make_shared<const TriangleMesh>(scaled(*outcome.raw, metres(outcome.unit)));
        MeshComparisonOptions options;
        options.fitOffset = request.isOffsetFitted;
        auto comparison = compareWithMesh(request.modules, *outcome.mesh, options, comparing);
        if (comparison)
            outcome.comparison = std::make_shared<const MeshComparison>(*std::move(comparison));
        else
            outcome.complaint = sentenceOf(comparison.error());
    } catch (const std::bad_alloc&) {
        outcome.mesh.reset();
        outcome.complaint = tr("There is not enough memory for this mesh; one with fewer triangles will do.");
    }
    return outcome;
}

void MeshPresenter::start() {
    // One after the other: finish() begins the next.
    if (isBusy())
        return;
    isDue_ = false;
    cancelled_ = std::make_shared<std::atomic<bool>>(false);
    const Request request{run_, file_, raw_, placedModules(), unit_, isOffsetFitted_, cancelled_, forgotten_};
    watcher_.setFuture(QtConcurrent::run(&pool_, [request] { return compare(request); }));
}

void MeshPresenter::finish() {
    const Outcome outcome = watcher_.result();
    if (outcome.raw && !*outcome.forgotten)
        raw_ = outcome.raw;
    if (outcome.run == run_ && !isDue_) {
        mesh_ = outcome.mesh;
        usedUnit_ = outcome.unit;
        comparison_ = outcome.comparison;
        complaint_ = outcome.complaint;
    }
    if (isDue_ && isWanted())
        start();
    emit changed();
}

QString MeshPresenter::sentenceOf(const CalibrationError& error) {
    switch (error.code) {
        case ErrorCode::TooFewPoints:
            return tr("At least %1 placed modules are needed to lay the body on a mesh; there are %2.")
                .arg(error.numbers.at("needed"))
                .arg(error.numbers.at("found"));
        case ErrorCode::NoConsensus:
            return tr(
                "In no pose do half of the modules lie on this mesh. Is it the mesh of this body, "
                "in the unit chosen?");
        case ErrorCode::DegeneratePoints:
            return tr("The triangles of this mesh have no area.");
        case ErrorCode::NotFinite:
            return tr("A corner of this mesh or the place of a module is not a finite number.");
        case ErrorCode::Cancelled:
            return {};
        default:
            // compareWithMesh has no other.
            return tr("This mesh can't be compared.");
    }
}

QString MeshPresenter::sentenceOf(const AlignmentDoubt& doubt) {
    const auto mm = [](double metres, int digits) { return QString::number(1e3 * metres, 'f', digits); };
    switch (doubt.kind) {
        case AlignmentDoubt::Kind::OtherPoseFits:
            return tr("Another pose, %1 mm away, fits nearly as well (%2 mm rms): the shapes that the modules cover "
                      "occur more than once on this mesh, so where they lie is open.")
                .arg(mm(doubt.value, 0), mm(doubt.other, 2));
        case AlignmentDoubt::Kind::Slides:
            return tr("Shifted or turned by 10 mm along the surface in one direction, modules rise or fall by %1 mm "
                      "only: "
                      "deviations tell heights, and little of places.")
                .arg(10 * doubt.value, 0, 'f', 1);
        case AlignmentDoubt::Kind::OffsetUnknown:
            return tr("How far modules sit above the surface can't be told from where the body is (± %1 mm).")
                .arg(mm(doubt.value, 1));
        case AlignmentDoubt::Kind::FewCovered:
            return tr("The modules cover %1 % of this mesh.").arg(100 * doubt.value, 0, 'f', 1);
        case AlignmentDoubt::Kind::SizesDiffer:
            return tr("The mesh is %1 times as large as what the modules span: is its unit right?")
                .arg(doubt.value, 0, 'g', 2);
        case AlignmentDoubt::Kind::FitsBadly:
            return tr("Modules are typically %1 mm off: this is hardly the mesh of this body.").arg(mm(doubt.value, 1));
        default:
            return tr("%n modules have no surface near that faces their way.", nullptr, static_cast<int>(doubt.value));
    }
}

}  // namespace skincal
