// What the dialog is made of; what it does is in calibration_dialog.cpp.

#include <QFrame>
#include <QHeaderView>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTableView>
#include <QVBoxLayout>

#include "ui/pages/board_form.h"
#include "ui/pages/calibration_dialog.h"
#include "ui/pages/lens_card.h"
#include "ui/pages/page.h"
#include "ui/widgets/board_picture.h"
#include "ui/widgets/residual_plot.h"

namespace skincal {
namespace {

QPushButton* button(const QString& text, const char* name, const QString& why) {
    auto* button = new QPushButton(text);
    button->setObjectName(QString::fromLatin1(name));
    button->setToolTip(why);
    // Return in a field must not press any of them.
    button->setAutoDefault(false);
    return button;
}

}  // namespace

QWidget* CalibrationDialog::buildSight() {
    auto* panel = new QWidget;
    auto* column = new QVBoxLayout(panel);
    column->setContentsMargins(0, 0, 0, 0);
    picture_ = new BoardPicture;
    picture_->setPlaceholder(tr("The camera gives no picture."));
    column->addWidget(picture_, 1);
    sentence_ = new QLabel;
    sentence_->setObjectName(QStringLiteral("instruction"));
    sentence_->setTextFormat(Qt::RichText);
    // Long names of files must not widen the window.
    sentence_->setWordWrap(true);
    sentence_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    column->addWidget(sentence_);
    auto* row = new QHBoxLayout;
    wish_ = new QLabel;
    count_ = mutedLabel();
    count_->setWordWrap(false);
    progress_ = new QProgressBar;
    progress_->setRange(0, 100);
    progress_->setFixedWidth(180);
    progress_->setTextVisible(false);
    progress_->setStyleSheet(QStringLiteral("QProgressBar { min-height: 8px; max-height: 8px; }"));
    progress_->setAccessibleName(tr("How complete the boards are"));
    progress_->setToolTip(
        tr("Share of what a good calibration needs: boards at all edges, near and far, turned and tilted"));
    row->addWidget(wish_, 1);
    row->addWidget(count_);
    row->addWidget(progress_);
    column->addLayout(row);
    return panel;
}

QWidget* CalibrationDialog::buildBoards() {
    auto* panel = new QWidget;
    auto* row = new QHBoxLayout(panel);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(10);
    auto* column = new QVBoxLayout;
    boards_ = new QTableView;
    boards_->setObjectName(QStringLiteral("boards"));
    boards_->setAccessibleName(tr("Boards taken"));
    boards_->setToolTip(tr("Select one to see where it was and its residuals; Delete removes it"));
    boards_->setModel(model_);
    boards_->setSelectionBehavior(QAbstractItemView::SelectRows);
    boards_->setSelectionMode(QAbstractItemView::SingleSelection);
    boards_->setShowGrid(false);
    boards_->setTabKeyNavigation(false);
    boards_->verticalHeader()->setVisible(false);
    boards_->verticalHeader()->setDefaultSectionSize(22);
    boards_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
    boards_->horizontalHeader()->setHighlightSections(false);
    boards_->setMinimumSize(375, 100);
    column->addWidget(boards_, 1);
    auto* buttons = new QHBoxLayout;
    remove_ = button(tr("Remove board"), "removeBoard", tr("The selected board no longer counts"));
    startOver_ = button(tr("Start over"), "startOver", tr("Remove all boards, to take them anew or of another kind"));
    takeBack_ = button(tr("Take back"), "takeBoardBack", tr("What was removed last counts again (Ctrl+Z)"));
    buttons->addWidget(remove_);
    buttons->addWidget(startOver_);
    buttons->addWidget(takeBack_);
    buttons->addStretch();
    column->addLayout(buttons);
    row->addLayout(column, 3);
    plot_ = new ResidualPlot;
    row->addWidget(plot_, 2);
    return panel;
}

QWidget* CalibrationDialog::buildBoardCard() {
    auto* frame = new QFrame;
    frame->setObjectName(QStringLiteral("card"));
    auto* column = new QVBoxLayout(frame);
    column->setContentsMargins(12, 10, 12, 12);
    column->setSpacing(8);
    auto* heading = new QLabel(tr("Board"));
    heading->setObjectName(QStringLiteral("instruction"));
    column->addWidget(heading);
    form_ = new BoardForm(presenter_.plan());
    column->addWidget(form_);
    print_ = button(tr("Print board …"), "printBoard",
                    tr("Save the board as a PDF to print at its true size, with a ruler to check the print"));
    column->addWidget(print_);
    take_ = button({}, "takeBoards", tr("Boards that are sharp, still and new are taken by themselves"));
    take_->setProperty("primary", true);
    column->addWidget(take_);
    return frame;
}

QWidget* CalibrationDialog::buildSide() {
    auto* panel = new QWidget;
    panel->setFixedWidth(310);
    auto* column = new QVBoxLayout(panel);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(10);
    column->addWidget(buildBoardCard());
    lensCard_ = new LensCard(presenter_);
    column->addWidget(lensCard_, 1);
    auto* row = new QHBoxLayout;
    QPushButton* close = button(tr("Close"), "closeCalibration", tr("Boards stay for the next time"));
    connect(close, &QPushButton::clicked, this, &QDialog::reject);
    row->addStretch();
    row->addWidget(close);
    column->addLayout(row);
    return panel;
}

}  // namespace skincal
