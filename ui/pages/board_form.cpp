#include "ui/pages/board_form.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>

#include "ui/presenters/board_words.h"

namespace skincal {
namespace {

constexpr double kMetre_mm = 1000;

QSpinBox* squaresField(int value, const QString& name) {
    auto* field = new QSpinBox;
    field->setRange(3, 40);
    field->setValue(value);
    field->setAccessibleName(name);
    return field;
}

QDoubleSpinBox* lengthField(double value, const QString& name) {
    auto* field = new QDoubleSpinBox;
    field->setRange(0.5, 1000);
    field->setDecimals(2);
    field->setSuffix(BoardForm::tr(" mm"));
    field->setValue(value * kMetre_mm);
    field->setAccessibleName(name);
    return field;
}

}  // namespace

BoardForm::BoardForm(const BoardPlan& plan, QWidget* parent)
    : QWidget(parent),
      kind_(new QComboBox),
      columns_(squaresField(plan.columns, tr("Squares across"))),
      rows_(squaresField(plan.rows, tr("Squares down"))),
      square_(lengthField(plan.square, tr("Side of a square"))),
      marker_(lengthField(plan.marker, tr("Side of a marker"))),
      dictionary_(new QComboBox),
      fault_(new QLabel) {
    kind_->setObjectName(QStringLiteral("boardKind"));
    kind_->addItem(tr("ChArUco"), static_cast<int>(BoardKind::Charuco));
    kind_->addItem(tr("Chessboard"), static_cast<int>(BoardKind::Chessboard));
    kind_->setCurrentIndex(kind_->findData(static_cast<int>(plan.kind)));
    kind_->setAccessibleName(tr("Kind of board"));
    kind_->setToolTip(
        tr("ChArUco may reach beyond the picture, which shows the lens at its edges; a chessboard must be in it as a "
           "whole."));
    columns_->setObjectName(QStringLiteral("boardColumns"));
    columns_->setToolTip(tr("Squares along a row, black and white: not inner corners"));
    rows_->setToolTip(tr("Squares along a column, black and white: not inner corners"));
    square_->setToolTip(
        tr("Measure it on the print: printers scale. It decides how far away boards seem, not the lens."));
    marker_->setToolTip(tr("With its black border, 0.4 to 0.9 of a square"));
    for (int i = 0; i <= static_cast<int>(MarkerDictionary::Dict7x7_1000); ++i) {
        const std::string_view text = name(static_cast<MarkerDictionary>(i));
        dictionary_->addItem(QString::fromLatin1(text.data(), static_cast<qsizetype>(text.size())));
    }
    dictionary_->setCurrentIndex(static_cast<int>(plan.dictionary));
    dictionary_->setAccessibleName(tr("Dictionary of markers"));
    dictionary_->setToolTip(tr("ArUco markers on the board, by OpenCV's name: bits of a marker, number of markers"));
    fault_->setWordWrap(true);
    fault_->setVisible(false);

    auto* form = new QFormLayout(this);
    form->setContentsMargins(0, 0, 0, 0);
    form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    form->addRow(tr("Kind"), kind_);
    auto* squares = new QHBoxLayout;
    squares->addWidget(columns_, 1);
    squares->addWidget(new QLabel(tr("×")));
    squares->addWidget(rows_, 1);
    form->addRow(tr("Squares"), squares);
    form->addRow(tr("Square"), square_);
    form->addRow(tr("Marker"), marker_);
    form->addRow(tr("Dictionary"), dictionary_);
    form->addRow(fault_);
    for (auto* field : {kind_, dictionary_})
        connect(field, &QComboBox::currentIndexChanged, this, &BoardForm::refresh);
    for (auto* field : {columns_, rows_})
        connect(field, &QSpinBox::valueChanged, this, &BoardForm::refresh);
    for (auto* field : {square_, marker_})
        connect(field, &QDoubleSpinBox::valueChanged, this, &BoardForm::refresh);
    refresh();
}

BoardPlan BoardForm::plan() const {
    BoardPlan plan;
    plan.kind = static_cast<BoardKind>(kind_->currentData().toInt());
    plan.columns = columns_->value();
    plan.rows = rows_->value();
    plan.square = square_->value() / kMetre_mm;
    plan.marker = marker_->value() / kMetre_mm;
    plan.dictionary = static_cast<MarkerDictionary>(dictionary_->currentIndex());
    return plan;
}

QString BoardForm::fault() const {
    return planFault(plan());
}

void BoardForm::refresh() {
    const bool hasMarkers = plan().kind == BoardKind::Charuco;
    marker_->setEnabled(hasMarkers);
    dictionary_->setEnabled(hasMarkers);
    const QString why = fault();
    fault_->setText(tr("⚠ %1").arg(why));
    fault_->setVisible(!why.isEmpty());
    emit changed();
}

}  // namespace skincal
