#include "ui/presenters/link_model.h"

#include <QTimer>
#include <algorithm>
#include <set>

#include "core/estimation/skin_layout.h"
#include "ui/texts/sentences.h"

namespace skincal {
namespace {

QString portName(ModuleId module, int port) {
    return LinkModel::tr("%1, port %2").arg(module.value).arg(port);
}

std::set<LinkKey> keysOf(const Skin& skin) {
    std::set<LinkKey> keys;
    for (const Link& link : skin.links)
        keys.insert(LinkKey::of(link));
    return keys;
}

std::vector<JudgedLink> judgedLinks(Session& session) {
    const Decisions& decisions = session.decisions();
    // The operator's word counts at once, the next solution only says so, too.
    const auto judged = [&](const Link& link, LinkKind kind, const Sentence& reason) {
        const auto word = decisions.links.find(LinkKey::of(link));
        const bool decided = word != decisions.links.end();
        return JudgedLink{link, decided ? word->second : kind, said(reason), decided};
    };
    std::vector<JudgedLink> links;
    // A solution of an older network would name links that are gone.
    if (session.solution() && keysOf(session.solution()->measurements->skin) == keysOf(session.measured().skin)) {
        for (const BodyLink& link : session.solution()->body.links)
            links.push_back(judged(link.link, link.kind, link.reason));
        return links;
    }
    const Measurements measurements = measurementsOf(session.measured(), decisions);
    const GravityTable gravity(measurements.skin, {});
    const SkinLayout layout = layOutSkin(measurements, gravity);
    for (std::size_t i = 0; i < layout.verdicts.size(); ++i) {
        const GraphLink& link = layout.graph.links()[i];
        links.push_back(judged(measurements.skin.links[link.reported.front()], layout.verdicts[i].kind,
                               layout.verdicts[i].explanation));
    }
    return links;
}

}  // namespace

LinkModel::LinkModel(Workbench& workbench, QObject* parent) : QAbstractTableModel(parent), workbench_(workbench) {
    const Session& session = workbench.session();
    // Judging 1,000 modules' links by pictures that nothing was solved from yet takes tens of milliseconds, as where a
    // recording is opened: in an event of its own, and once, whatever changes together.
    auto* later = new QTimer(this);
    later->setSingleShot(true);
    connect(later, &QTimer::timeout, this, &LinkModel::refresh);
    const auto refreshInTime = [this, later] {
        Session& changed = workbench_.session();
        if (changed.solution() || changed.measured().views.empty())
            refresh();
        else
            later->start(0);
    };
    connect(&session, &Session::skinChanged, this, refreshInTime);
    connect(&session, &Session::solutionChanged, this, refreshInTime);
    connect(&session, &Session::decisionsChanged, this, refreshInTime);
    refresh();
}

int LinkModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : static_cast<int>(links_.size());
}

int LinkModel::columnCount(const QModelIndex& parent) const {
    return parent.isValid() ? 0 : Columns;
}

QVariant LinkModel::data(const QModelIndex& index, int role) const {
    if (!checkIndex(index, CheckIndexOption::IndexIsValid))
        return {};
    const JudgedLink& row = links_[static_cast<std::size_t>(index.row())];
    if (role == Qt::ToolTipRole)
        return row.reason;
    if (role != Qt::DisplayRole)
        return {};
    switch (index.column()) {
        case From:
            return portName(row.link.a, row.link.a_port);
        case To:
            return portName(row.link.b, row.link.b_port);
        case Verdict: {
            const QString kind = row.kind == LinkKind::Cable ? tr("Cable") : tr("Neighbours");
            return row.isOperatorsWord ? tr("%1 (your word)").arg(kind) : kind;
        }
        case Reason:
            return row.reason;
        default:
            return {};
    }
}

QVariant LinkModel::headerData(int section, Qt::Orientation orientation, int role) const {
    if (orientation != Qt::Horizontal || role != Qt::DisplayRole)
        return {};
    switch (section) {
        case From:
            return tr("From");
        case To:
            return tr("To");
        case Verdict:
            return tr("Judged as");
        case Reason:
            return tr("Why");
        default:
            return {};
    }
}

void LinkModel::overrule(int row, std::optional<LinkKind> kind) {
    const LinkKey key = LinkKey::of(links_.at(static_cast<std::size_t>(row)).link);
    const QString text = !kind                      ? tr("Judge the link %1–%2 by the data")
                         : *kind == LinkKind::Cable ? tr("Call the link %1–%2 a cable")
                                                    : tr("Call %1 and %2 neighbours");
    workbench_.session().decide(text.arg(key.a.value).arg(key.b.value), [&](Decisions& decisions) {
        if (kind)
            decisions.links[key] = *kind;
        else
            decisions.links.erase(key);
    });
}

void LinkModel::refresh() {
    beginResetModel();
    links_ = judgedLinks(workbench_.session());
    std::stable_sort(links_.begin(), links_.end(), [](const JudgedLink& a, const JudgedLink& b) {
        return (a.kind == LinkKind::Cable) > (b.kind == LinkKind::Cable);
    });
    endResetModel();
}

}  // namespace skincal
