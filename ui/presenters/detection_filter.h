#pragma once

#include <QSortFilterProxyModel>

#include "ui/presenters/detection_model.h"

namespace skincal {

/// Those detections of a view that are asked for, sorted. At first all are.
class DetectionFilter : public QSortFilterProxyModel {
    Q_OBJECT
  public:
    explicit DetectionFilter(DetectionModel& detections, QObject* parent = nullptr);

    /// Modules whose number has these digits in it; empty for all.
    void setNumber(const QString& digits);
    /// What does not count, and what counts though it is farther from the body than the limit.
    void setDoubtfulOnly(bool isOn);
    /// What is farther from the body than the limit.
    void setFarOnly(bool isOn);
    void setLimit(double residual_px);
    /// Shows all again.
    void clear();

    [[nodiscard]] bool isOn() const { return !digits_.isEmpty() || isDoubtfulOnly_ || isFarOnly_; }
    [[nodiscard]] double limit() const { return limit_px_; }
    [[nodiscard]] const DetectionRow& rowAt(int row) const;

  protected:
    [[nodiscard]] bool filterAcceptsRow(int row, const QModelIndex& parent) const override;

  private:
    DetectionModel& detections_;
    QString digits_;
    bool isDoubtfulOnly_ = false;
    bool isFarOnly_ = false;
    double limit_px_ = 0.5;  ///< several times what a steady camera and a sound body leave
};

}  // namespace skincal
