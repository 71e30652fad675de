#include "ui/presenters/detection_model.h"

#include <algorithm>
#include <map>
#include <set>

#include "ui/texts/sentences.h"

namespace skincal {
namespace {

using State = DetectionRow::State;

State stateOf(const Undetected& undetected) {
    using Cause = Undetected::Cause;
    switch (undetected.cause) {
        case Cause::TooWeak:
            return State::TooWeak;
        case Cause::Reflected:
            return State::Reflected;
        case Cause::Alike:
            return State::Ambiguous;
        case Cause::NotAnLed:
            return State::NotAnLed;
        case Cause::TooBright:
            return State::TooBright;
        case Cause::NeverBlinked:
            return State::NeverLit;
        case Cause::CameraMoved:
            return State::CameraMoved;
        case Cause::Rejected:
            return State::Rejected;
        default:
            return undetected.verdict == DetectionVerdict::Ambiguous ? State::Ambiguous : State::NotVisible;
    }
}

/// The picture alone can't tell, but the body may.
bool isOpen(State state) {
    return state == State::Ambiguous || state == State::Reflected;
}

/// What the decoder made of a view.
std::map<ModuleId, DetectionRow> decodedRows(const ScannedView& view, const Skin& skin, const Decisions& decisions) {
    std::map<ModuleId, DetectionRow> rows;
    std::set<ModuleId> several;  // spots to choose from
    const ViewDetections& decoded = view.decoded;
    for (std::size_t i = 0; i < decoded.found.size(); ++i) {
        const LedDetection& found = decoded.found[i];
        rows[found.module] = {found.module, State::Used, found.pixel, found.sigma_px, std::nullopt, false, {}, {}};
        if (i < decoded.readings.size())
            rows[found.module].reading = decoded.readings[i];
    }
    for (const Undetected& undetected : view.decoded.undetected) {
        DetectionRow& row = rows[undetected.module];
        row.module = undetected.module;
        row.state = stateOf(undetected);
        row.reason = said(undetected.reason);
        if (undetected.nearest)
            row.reading = undetected.nearest->reading;
        if (!undetected.spots.empty())
            several.insert(undetected.module);
    }
    // Recordings without pictures name what they found alone; and a skin may have grown.
    for (const SkinModule& module : skin.modules) {
        DetectionRow missing;
        missing.module = module.id;
        missing.reason = view.frames.empty() ? DetectionModel::tr("the recording has no spot of it")
                                             : DetectionModel::tr("it was not connected when this view was scanned");
        rows.try_emplace(module.id, std::move(missing));
    }
    for (auto& [module, row] : rows) {
        const auto decision = decisions.detections.find({view.name, module});
        if (decision == decisions.detections.end() || decision->second.verdict != "rejected" ||
            (!row.pixel && !several.contains(module)))
            continue;
        row.state = State::Rejected;
        row.isOperatorsWord = true;
        row.reason = QString::fromStdString(decision->second.reason);
    }
    return rows;
}

/// The one that the body settled on; null where it has no such spot.
const SpotChoice* choiceAt(const ScannedView& view, ModuleId module, const Vector2d& pixel) {
    for (const Undetected& undetected : view.decoded.undetected) {
        for (const SpotChoice& spot : undetected.spots) {
            if (undetected.module == module && spot.pixel == pixel)
                return &spot;
        }
    }
    return nullptr;
}

void addResiduals(const BodyView& view, const ScannedView& scanned, std::map<ModuleId, DetectionRow>& rows) {
    for (const BodyObservation& observation : view.observations) {
        const auto found = rows.find(observation.module);
        if (found == rows.end() || found->second.isOperatorsWord)
            continue;
        DetectionRow& row = found->second;
        if (observation.residual)
            row.residual_px = observation.residual->norm();
        if (isOpen(row.state))
            row.reason = said(observation.reason);
        // The body told which of several spots it is.
        if (isOpen(row.state) && observation.verdict == ObservationVerdict::Used) {
            row.state = State::Used;
            row.pixel = observation.pixel;
            if (const SpotChoice* choice = choiceAt(scanned, observation.module, *observation.pixel)) {
                row.sigma_px = choice->sigma_px;
                row.reading = choice->reading.planes > 0 ? std::optional(choice->reading) : std::nullopt;
            }
        }
        if (observation.verdict == ObservationVerdict::Rejected) {
            row.state = State::SetAside;
            row.reason = said(observation.reason);
        }
    }
}

}  // namespace

QString nameOf(DetectionRow::State state) {
    switch (state) {
        case State::Used:
            return DetectionModel::tr("used");
        case State::SetAside:
            return DetectionModel::tr("set aside");
        case State::Rejected:
            return DetectionModel::tr("rejected");
        case State::Reflected:
            return DetectionModel::tr("reflected");
        case State::Ambiguous:
            return DetectionModel::tr("ambiguous");
        case State::TooWeak:
            return DetectionModel::tr("too weak");
        case State::TooBright:
            return DetectionModel::tr("too bright");
        case State::NotAnLed:
            return DetectionModel::tr("not an LED");
        case State::CameraMoved:
            return DetectionModel::tr("camera moved");
        case State::NeverLit:
            return DetectionModel::tr("never lit");
        default:
            return DetectionModel::tr("not visible");
    }
}

QString meaningOf(DetectionRow::State state) {
    switch (state) {
        case State::Used:
            return DetectionModel::tr("Found, and the body rests on it.");
        case State::SetAside:
            return DetectionModel::tr("Found, but it disagrees with all else that was measured, and does not count.");
        case State::Rejected:
            return DetectionModel::tr("You said that this is not its LED.");
        case State::Reflected:
            return DetectionModel::tr(
                "Several spots blink its word, the LED and its mirror images, or a single one does where a mirror "
                "shows "
                "others. Cover what mirrors, or look from another side.");
        case State::Ambiguous:
            return DetectionModel::tr("A spot fits it no better than another module. Another scan has other words.");
        case State::TooWeak:
            return DetectionModel::tr(
                "What may be its spot hardly rises above the noise. Go nearer, expose longer or dim the room.");
        case State::TooBright:
            return DetectionModel::tr("Its spot is clipped, so that its centre can't be told. Expose shorter.");
        case State::NotAnLed:
            return DetectionModel::tr("What blinks its word is no clean spot: stray light, or light of others in it.");
        case State::CameraMoved:
            return DetectionModel::tr("The camera moved while its word was shown. Scan again with the camera at rest.");
        case State::NeverLit:
            return DetectionModel::tr("Its LED was not lit so that it could be told from others.");
        default:
            return DetectionModel::tr(
                "Nothing in the picture blinks its word: it is turned away, hidden or out of the picture.");
    }
}

DetectionModel::DetectionModel(Workbench& workbench, QObject* parent)
    : QAbstractTableModel(parent), workbench_(workbench) {
    const Session& session = workbench.session();
    connect(&session, &Session::viewsChanged, this, &DetectionModel::refresh);
    connect(&session, &Session::decisionsChanged, this, &DetectionModel::refresh);
    connect(&session, &Session::solutionChanged, this, &DetectionModel::refresh);
}

void DetectionModel::setView(const std::string& view) {
    view_ = view;
    refresh();
}

int DetectionModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int DetectionModel::columnCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : Columns;
}

QVariant DetectionModel::data(const QModelIndex& index, int role) const {
    if (!checkIndex(index, CheckIndexOption::IndexIsValid))
        return {};
    const DetectionRow& row = rows_[static_cast<std::size_t>(index.row())];
    const auto number = [&](const std::optional<double>& value) -> QVariant {
        if (role == kSortRole)
            return value.value_or(-1);
        return value ? QVariant(tr("%1 px").arg(*value, 0, 'f', 3)) : QVariant(tr("–"));
    };
    if (role == Qt::ToolTipRole)
        return index.column() == State || row.reason.isEmpty() ? meaningOf(row.state) : row.reason;
    const bool isNumber = index.column() == Module || index.column() == Residual || index.column() == Sigma;
    if (role == Qt::TextAlignmentRole)
        return static_cast<int>((isNumber ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
    if (role != Qt::DisplayRole && role != kSortRole)
        return {};
    switch (index.column()) {
        case Module:
            return row.module.value;
        case State:
            if (role == kSortRole)
                return static_cast<int>(row.state);
            return row.isOperatorsWord ? tr("%1 (your word)").arg(nameOf(row.state)) : nameOf(row.state);
        case Residual:
            return number(row.residual_px);
        case Sigma:
            return number(row.sigma_px);
        case Reason:
            return row.reason;
        default:
            return {};
    }
}

QVariant DetectionModel::headerData(int section, Qt::Orientation orientation, int role) const {
    if (orientation != Qt::Horizontal)
        return {};
    if (role == Qt::ToolTipRole && section == Residual)
        return tr("Distance between the spot in the picture and where the body has it");
    if (role == Qt::ToolTipRole && section == Sigma)
        return tr("How well the centre of the spot is known");
    if (role != Qt::DisplayRole)
        return {};
    switch (section) {
        case Module:
            return tr("Module");
        case State:
            return tr("State");
        case Residual:
            return tr("Residual");
        case Sigma:
            return tr("Sigma");
        case Reason:
            return tr("Why");
        default:
            return {};
    }
}

std::optional<int> DetectionModel::rowOf(ModuleId module) const {
    const auto found =
        std::find_if(rows_.begin(), rows_.end(), [&](const DetectionRow& row) { return row.module == module; });
    if (found == rows_.end())
        return std::nullopt;
    return static_cast<int>(found - rows_.begin());
}

void DetectionModel::reject(const std::vector<ModuleId>& modules, const QString& why) {
    workbench_.session().decide(
        tr("Reject %n detections in %1", nullptr, static_cast<int>(modules.size())).arg(view_.c_str()),
        [&](Decisions& decisions) {
            for (const ModuleId module : modules)
                decisions.detections[{view_, module}] = {view_, module, "rejected", why.toStdString()};
        });
}

void DetectionModel::accept(const std::vector<ModuleId>& modules) {
    workbench_.session().decide(
        tr("Accept %n detections in %1", nullptr, static_cast<int>(modules.size())).arg(view_.c_str()),
        [&](Decisions& decisions) {
            for (const ModuleId module : modules)
                decisions.detections.erase({view_, module});
        });
}

void DetectionModel::refresh() {
    Session& session = workbench_.session();
    std::map<ModuleId, DetectionRow> rows;
    if (const ScannedView* view = session.findView(view_)) {
        rows = decodedRows(*view, session.measured().skin, session.decisions());
        if (session.solution()) {
            for (const BodyView& solved : session.solution()->body.views) {
                if (solved.name == view_)
                    addResiduals(solved, *view, rows);
            }
        }
    }
    beginResetModel();
    rows_.clear();
    for (auto& [module, row] : rows)
        rows_.push_back(std::move(row));
    endResetModel();
}

}  // namespace skincal
