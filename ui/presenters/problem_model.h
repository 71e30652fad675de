#pragma once

#include <QAbstractListModel>

#include "ui/presenters/step_model.h"

namespace skincal {

/// Something that is wrong or missing, in plain words, and where it is mended.
struct Problem {
    enum class Severity { Note, Warning, Error };
    Severity severity = Severity::Warning;
    Step step = Step::Connect;
    QString text;
    std::vector<ModuleId> modules;  ///< to point at in the 3D view
    std::string view;               ///< to open
    int pose = -1;                  ///< to select
    QString directory{};            ///< of a session to open
};

/// Everything that is wrong at the moment, the gravest first.
class ProblemModel : public QAbstractListModel {
    Q_OBJECT
  public:
    enum Role { SeverityRole = Qt::UserRole, StepRole };

    ProblemModel(Workbench& workbench, const ConnectPresenter& connection, const ScanPresenter& scan,
                 QObject* parent = nullptr);

    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
    [[nodiscard]] const Problem& problemAt(int row) const { return problems_.at(static_cast<std::size_t>(row)); }

    /// A file that could not be read or written; until the next one or clearNotice().
    void setNotice(const QString& text, Step step);
    void clearNotice();
    /// A session that was not saved; empty takes the offer back.
    void setKept(const QString& directory, const QString& when);
    [[nodiscard]] bool isOfferTaken() const { return !kept_.has_value(); }

  private:
    void refresh();
    void collect(std::vector<Problem>& problems) const;

    Workbench& workbench_;
    const ConnectPresenter& connection_;
    const ScanPresenter& scan_;
    std::vector<Problem> problems_;
    std::optional<Problem> notice_;
    std::optional<Problem> kept_;
    QString cameraFailure_;
};

}  // namespace skincal
