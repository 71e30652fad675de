#include "ui/pages/calibration_dialog.h"

#include <QEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QShortcut>
#include <QTableView>
#include <QTimer>
#include <QtConcurrent/QtConcurrentRun>

#include "ui/pages/board_form.h"
#include "ui/pages/lens_card.h"
#include "ui/presenters/board_sign.h"
#include "ui/print/board_pdf.h"
#include "ui/widgets/board_picture.h"
#include "ui/widgets/image_conversion.h"
#include "ui/widgets/primary_button.h"
#include "ui/widgets/residual_plot.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

std::vector<QPointF> pixelsOf(const BoardView& view) {
    std::vector<QPointF> pixels;
    for (const BoardCorner& corner : view.corners)
        pixels.emplace_back(corner.pixel.x(), corner.pixel.y());
    return pixels;
}

}  // namespace

CalibrationDialog::CalibrationDialog(BoardPresenter& presenter, const ScanPresenter& scan, QWidget* parent)
    : QDialog(parent), presenter_(presenter), scan_(scan), model_(new BoardModel(presenter, this)) {
    setObjectName(QStringLiteral("calibration"));
    setWindowTitle(tr("Calibrate the camera"));
    resize(1180, 780);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(16, 14, 16, 14);
    row->setSpacing(14);
    auto* left = new QVBoxLayout;
    left->setSpacing(10);
    left->addWidget(buildSight(), 5);
    left->addWidget(buildBoards(), 2);
    row->addLayout(left, 1);
    row->addWidget(buildSide());
    connectAll();
    showLive();
    showBoards();
    showState();
    take_->setFocus();
}

void CalibrationDialog::connectAll() {
    connect(form_, &BoardForm::changed, this, [this] {
        if (form_->fault().isEmpty())
            presenter_.setPlan(form_->plan());
        showState();
    });
    connect(take_, &QPushButton::clicked, this, &CalibrationDialog::startOrStop);
    connect(print_, &QPushButton::clicked, this, &CalibrationDialog::choosePrint);
    connect(startOver_, &QPushButton::clicked, &presenter_, &BoardPresenter::clear);
    connect(takeBack_, &QPushButton::clicked, &presenter_, &BoardPresenter::takeBack);
    connect(new QShortcut(QKeySequence::Undo, this), &QShortcut::activated, &presenter_, &BoardPresenter::takeBack);
    connect(lensCard_, &LensCard::used, this, &QDialog::accept);
    connect(lensCard_, &LensCard::told, this, &CalibrationDialog::tell);
    const auto remove = [this] {
        if (const auto board = chosenBoard())
            presenter_.remove(*board);
    };
    connect(remove_, &QPushButton::clicked, this, remove);
    connect(new QShortcut(QKeySequence::Delete, boards_, nullptr, nullptr, Qt::WidgetShortcut), &QShortcut::activated,
            this, remove);
    connect(boards_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &CalibrationDialog::showChosen);
    connect(model_, &QAbstractItemModel::rowsInserted, boards_, &QTableView::scrollToBottom);
    connect(&presenter_, &BoardPresenter::sightChanged, this, &CalibrationDialog::showSight);
    connect(&presenter_, &BoardPresenter::boardsChanged, this, [this] {
        // What was written while it looks has been read by now.
        note_.clear();
        showBoards();
    });
    connect(&presenter_, &BoardPresenter::calibrationChanged, this, &CalibrationDialog::showResiduals);
    connect(&presenter_, &BoardPresenter::stateChanged, this, &CalibrationDialog::showState);
    connect(&presenter_, &BoardPresenter::interrupted, this,
            [this](const QString& why) { tell(tr("Interrupted: %1").arg(why), true); });
    connect(&scan_, &ScanPresenter::pictureChanged, this, &CalibrationDialog::showLive);
}

void CalibrationDialog::done(int result) {
    presenter_.stop();
    QDialog::done(result);
}

void CalibrationDialog::changeEvent(QEvent* event) {
    QDialog::changeEvent(event);
    // The sentence's mark has the theme's colours.
    if (event->type() == QEvent::PaletteChange && sentence_ != nullptr)
        showSight();
}

void CalibrationDialog::startOrStop() {
    note_.clear();
    presenter_.isLooking() ? presenter_.stop() : presenter_.start();
}

void CalibrationDialog::choosePrint() {
    const QString file = QFileDialog::getSaveFileName(this, tr("Save the board for printing"),
                                                      QStringLiteral("board.pdf"), tr("PDF (*.pdf)"));
    if (!file.isEmpty())
        printBoard(file);
}

void CalibrationDialog::printBoard(const QString& file) {
    QtConcurrent::run([file, plan = form_->plan()] {
        return writeBoardPdf(file.toStdString(), plan);
    }).then(this, [this, file](const tl::expected<void, QString>& written) {
        tell(written ? tr("Written: %1. Print it without scaling and check the ruler.").arg(file) : written.error(),
             !written);
    });
}

void CalibrationDialog::saveAs(const QString& file, CameraFileKind kind) {
    lensCard_->saveAs(file, kind);
}

void CalibrationDialog::showLive() {
    // While it looks, the picture that was searched is shown: the corners are where that has them.
    if (isVisible() && (!presenter_.isLooking() || presenter_.sight().picture.empty()))
        picture_->setImage(toImage(scan_.picture()));
}

void CalibrationDialog::tell(const QString& note, bool isBad) {
    note_ = note;
    isNoteBad_ = isBad;
    showSight();
    // While it looks, what to do with the board matters more.
    QTimer::singleShot(std::chrono::seconds(4), this, [this, note] {
        if (note_ != note || !presenter_.isLooking())
            return;
        note_.clear();
        showSight();
    });
}

void CalibrationDialog::say(const QString& mark, const QColor& colour, const QString& sentence) {
    sentence_->setText(QStringLiteral("<span style=\"color:%1\">%2</span>&nbsp; %3")
                           .arg(colour.name(), mark, sentence.toHtmlEscaped()));
}

void CalibrationDialog::showSight() {
    const Theme theme = Theme::current();
    const BoardSight& sight = presenter_.sight();
    const bool isKept = sight.kind == BoardSight::Kind::Kept;
    if (!note_.isEmpty())
        say(isNoteBad_ ? tr("⚠") : tr("✓"), isNoteBad_ ? theme.bad : theme.good, note_);
    else if (!presenter_.isLooking())
        say(tr("○"), theme.muted, tr("Press Start and show the board to the camera."));
    else if (sight.kind == BoardSight::Kind::None)
        say(tr("○"), theme.muted, tr("Looking for the board …"));
    else
        say(isKept ? tr("✓") : tr("●"), isKept ? theme.good : theme.attention, sight.sentence);
    if (presenter_.isLooking() && !sight.picture.empty())
        picture_->setImage(toImage(sight.picture));
    // On the picture, whose brightness does not follow the theme.
    const Theme bright = Theme::dark();
    picture_->setCorners(sight.view ? pixelsOf(*sight.view) : std::vector<QPointF>(),
                         isKept ? bright.good : bright.attention);
}

void CalibrationDialog::showBoards() {
    const BoardCollector& boards = presenter_.boards();
    const BoardCollectorOptions grid;
    picture_->setCoverage(grid.gridColumns, grid.gridRows, boards.coverage());
    const std::size_t count = boards.views().size();
    progress_->setValue(static_cast<int>(100 * boards.progress()));
    count_->setText(tr("%n boards", nullptr, static_cast<int>(count)));
    const QString wish = presenter_.wish();
    wish_->setText(wish.isEmpty() ? tr("That is enough. Further boards still help a little.")
                                  : tr("<b>Next:</b> %1").arg(wish.toHtmlEscaped()));
    startOver_->setEnabled(count > 0);
    takeBack_->setEnabled(presenter_.canTakeBack());
    form_->setEnabled(count == 0);
    form_->setToolTip(count == 0 ? QString() : tr("Boards of this kind were taken: start over to change it"));
    showChosen();
    showResiduals();
}

void CalibrationDialog::showResiduals() {
    std::vector<ResidualPlot::Cloud> clouds;
    const auto& calibration = presenter_.calibration();
    if (calibration) {
        for (std::size_t i = 0; i < calibration->boards.size(); ++i) {
            ResidualPlot::Cloud cloud{boardSign(i), {}, calibration->boards[i].used};
            for (const Vector2d& r : calibration->boards[i].residuals)
                cloud.residuals.emplace_back(r.x(), r.y());
            clouds.push_back(std::move(cloud));
        }
    }
    // Once there is enough, using it comes next.
    setPrimary(take_, !(presenter_.canAccept() && presenter_.wish().isEmpty()));
    plot_->setPlaceholder(tr("How far corners lie from where the lens has them shows here."));
    plot_->setClouds(std::move(clouds));
}

void CalibrationDialog::showState() {
    const QString fault = form_->fault();
    take_->setText(presenter_.isLooking() ? tr("Stop") : tr("Start"));
    take_->setEnabled(fault.isEmpty());
    print_->setEnabled(fault.isEmpty());
    showLive();
    showSight();
}

std::optional<std::size_t> CalibrationDialog::chosenBoard() const {
    const QModelIndexList rows = boards_->selectionModel()->selectedRows();
    return rows.isEmpty() ? std::nullopt : std::optional(static_cast<std::size_t>(rows.front().row()));
}

void CalibrationDialog::showChosen() {
    const auto board = chosenBoard();
    remove_->setEnabled(board.has_value());
    plot_->setSelected(board);
    const auto& views = presenter_.boards().views();
    if (board && *board < views.size())
        picture_->setChosen(pixelsOf(views[*board]), boardSign(*board).colour);
    else
        picture_->setChosen({}, {});
}

}  // namespace skincal
