#pragma once

#include <QAbstractTableModel>

#include "ui/presenters/workbench.h"

namespace skincal {

/// A link as the window shows it: what it was judged, and why.
struct JudgedLink {
    Link link;
    LinkKind kind = LinkKind::Adjacent;
    QString reason;
    bool isOperatorsWord = false;
};

/// All links with their verdicts, cables first. Of the newest solution; before the first, what the wiring alone tells.
class LinkModel : public QAbstractTableModel {
    Q_OBJECT
  public:
    enum Column { From, To, Verdict, Reason, Columns };

    explicit LinkModel(Workbench& workbench, QObject* parent = nullptr);

    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
    [[nodiscard]] QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

    [[nodiscard]] const std::vector<JudgedLink>& links() const { return links_; }
    /// The operator's word; nothing takes it back. Undoable.
    void overrule(int row, std::optional<LinkKind> kind);

  private:
    void refresh();

    Workbench& workbench_;
    std::vector<JudgedLink> links_;
};

}  // namespace skincal
