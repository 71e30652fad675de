#pragma once

#include <QAbstractListModel>

#include "core/procedure/steps.h"
#include "ui/presenters/connect_presenter.h"
#include "ui/presenters/scan_presenter.h"

namespace skincal {

[[nodiscard]] QString nameOf(Step step);
/// What the step asks of the operator or why it waits; empty where there is nothing to say.
[[nodiscard]] QString sentenceOf(StepReason reason);

/// The steps with their states, as the window's left side shows them.
class StepModel : public QAbstractListModel {
    Q_OBJECT
  public:
    enum Role { StatusRole = Qt::UserRole, ReasonRole };

    StepModel(Workbench& workbench, const ConnectPresenter& connection, const ScanPresenter& scan,
              QObject* parent = nullptr);

    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;

    [[nodiscard]] const StepStates& states() const { return states_; }
    [[nodiscard]] Step next() const { return nextStep(states_); }

    /// A body was written to a file.
    void noteExport(std::shared_ptr<const Solution> of);

  signals:
    void changed();

  private:
    [[nodiscard]] Progress progress() const;
    void refresh();

    Workbench& workbench_;
    const ConnectPresenter& connection_;
    const ScanPresenter& scan_;
    StepStates states_;
    std::shared_ptr<const Solution> exported_;  ///< the newest that was; null where none was
    bool isCameraLost_ = false;
    bool hadPictures_ = false;
};

}  // namespace skincal
