#include "ui/presenters/detection_filter.h"

namespace skincal {

DetectionFilter::DetectionFilter(DetectionModel& detections, QObject* parent)
    : QSortFilterProxyModel(parent), detections_(detections) {
    setSourceModel(&detections);
    setSortRole(DetectionModel::kSortRole);
}

void DetectionFilter::setNumber(const QString& digits) {
    digits_ = digits.trimmed();
    invalidateFilter();
}

void DetectionFilter::setDoubtfulOnly(bool isOn) {
    isDoubtfulOnly_ = isOn;
    invalidateFilter();
}

void DetectionFilter::setFarOnly(bool isOn) {
    isFarOnly_ = isOn;
    invalidateFilter();
}

void DetectionFilter::setLimit(double residual_px) {
    limit_px_ = residual_px;
    if (isDoubtfulOnly_ || isFarOnly_)
        invalidateFilter();
}

void DetectionFilter::clear() {
    digits_.clear();
    isDoubtfulOnly_ = false;
    isFarOnly_ = false;
    invalidateFilter();
}

const DetectionRow& DetectionFilter::rowAt(int row) const {
    return detections_.rows().at(static_cast<std::size_t>(mapToSource(index(row, 0)).row()));
}

bool DetectionFilter::filterAcceptsRow(int row, const QModelIndex&) const {
    const DetectionRow& detection = detections_.rows().at(static_cast<std::size_t>(row));
    const bool isFar = detection.residual_px && *detection.residual_px > limit_px_;
    if (isFarOnly_ && !isFar)
        return false;
    if (isDoubtfulOnly_ && !isFar && detection.state == DetectionRow::State::Used)
        return false;
    return digits_.isEmpty() || QString::number(detection.module.value).contains(digits_);
}

}  // namespace skincal
