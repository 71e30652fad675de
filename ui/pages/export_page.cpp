#include "ui/pages/export_page.h"

#include <QDir>
#include <QFileDialog>
#include <QLineEdit>
#include <QListWidget>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QStandardPaths>

namespace skincal {
namespace {

constexpr int kPreviewLines = 200;

QString suggestedFile(const QString& suffix) {
    const QString documents = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
    return QDir(QDir(documents).exists() ? documents : QDir::homePath()).filePath(QStringLiteral("skin") + suffix);
}

}  // namespace

ExportPage::ExportPage(ExportPresenter& presenter, QWidget* parent)
    : Page(tr("Export"), tr("Give the body to the robot. Files are written whole or not at all."), parent),
      presenter_(presenter),
      formats_(new QListWidget),
      description_(mutedLabel()),
      preview_(new QPlainTextEdit),
      file_(new QLineEdit),
      write_(new QPushButton(tr("Write"))),
      outcome_(mutedLabel()) {
    auto* row = new QHBoxLayout;
    for (const ExportFormat& format : presenter.formats())
        formats_->addItem(format.name);
    formats_->setObjectName(QStringLiteral("formats"));
    formats_->setAccessibleName(tr("Formats"));
    formats_->setToolTip(tr("Who is to read the file decides; beside it stand its units and frames"));
    formats_->setMaximumWidth(150);
    formats_->setSpacing(3);
    formats_->setCurrentRow(0);
    row->addWidget(formats_);
    auto* column = new QVBoxLayout;
    column->addWidget(description_);
    preview_->setReadOnly(true);
    preview_->setLineWrapMode(QPlainTextEdit::NoWrap);
    preview_->setAccessibleName(tr("Preview of the file"));
    preview_->setToolTip(tr("How the file will begin, to see that it is what you need before it is written"));
    QFont fixed(QStringLiteral("monospace"));
    fixed.setStyleHint(QFont::Monospace);
    fixed.setPointSize(9);
    preview_->setFont(fixed);
    column->addWidget(preview_, 1);
    row->addLayout(column, 1);
    body().addLayout(row, 1);
    auto* target = new QHBoxLayout;
    file_->setObjectName(QStringLiteral("file"));
    file_->setAccessibleName(tr("File"));
    file_->setToolTip(tr("Where the file goes; its ending is that of the format"));
    file_->setText(suggestedFile(presenter.formats().front().suffix));
    auto* browse = new QPushButton(tr("Choose …"));
    browse->setToolTip(tr("Choose where to write the file"));
    write_->setObjectName(QStringLiteral("write"));
    write_->setProperty("primary", true);
    write_->setToolTip(tr("Write the file; one that is there is replaced once the new one is complete"));
    target->addWidget(file_, 1);
    target->addWidget(browse);
    target->addWidget(write_);
    body().addLayout(target);
    body().addWidget(outcome_);

    connect(formats_, &QListWidget::currentRowChanged, this, [this] {
        QString name = file_->text();
        for (const ExportFormat& format : presenter_.formats()) {
            if (name.endsWith(format.suffix))
                name.chop(format.suffix.size());
        }
        file_->setText(name + presenter_.formats()[format()].suffix);
        outcome_->clear();  // it is of another file
        refresh();
    });
    connect(browse, &QPushButton::clicked, this, &ExportPage::browse);
    connect(write_, &QPushButton::clicked, this, &ExportPage::write);
    connect(file_, &QLineEdit::returnPressed, write_, &QPushButton::click);
    connect(&presenter, &ExportPresenter::changed, this, [this] {
        outcome_->clear();
        refresh();
    });
    connect(&presenter, &ExportPresenter::previewed, this, [this](const QString& text) {
        preview_->setPlainText(text.isEmpty() ? tr("There is no placed module to export yet.") : text);
    });
    connect(
        &presenter, &ExportPresenter::written, this,
        [this](const QString& file, const std::shared_ptr<const Solution>& of) {
            const BodyQuality& quality = of->body.quality;
            finish(tr("Written: %1, %2 of %3 modules.").arg(file).arg(quality.modulesPlaced).arg(quality.modulesTotal));
        });
    connect(&presenter, &ExportPresenter::failed, this, &ExportPage::finish);
    refresh();
}

std::size_t ExportPage::format() const {
    return static_cast<std::size_t>(std::max(0, formats_->currentRow()));
}

void ExportPage::setActive(bool active) {
    isActive_ = active;
    refresh();
}

void ExportPage::refresh() {
    // A preview writes the whole file, which takes its time with 1,000 modules: only where it is seen.
    if (!isActive_)
        return;
    description_->setText(presenter_.formats()[format()].description);
    presenter_.preview(format(), kPreviewLines);
    write_->setEnabled(presenter_.body() != nullptr && !presenter_.isWriting());
}

void ExportPage::browse() {
    const QString chosen = QFileDialog::getSaveFileName(
        this, tr("Export"), file_->text(),
        tr("%1 (*%2)").arg(presenter_.formats()[format()].name, presenter_.formats()[format()].suffix));
    if (!chosen.isEmpty())
        file_->setText(chosen);
}

void ExportPage::write() {
    outcome_->setText(tr("Writing %1 …").arg(file_->text()));
    presenter_.write(format(), file_->text().toStdString());
    write_->setEnabled(!presenter_.isWriting());
}

void ExportPage::finish(const QString& outcome) {
    outcome_->setText(outcome);
    write_->setEnabled(presenter_.body() != nullptr && !presenter_.isWriting());
}

}  // namespace skincal
