#include "ui/pages/video_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>

#include "core/camera/media_source.h"

namespace skincal {

VideoDialog::VideoDialog(QWidget* parent) : QDialog(parent), where_(new QLineEdit) {
    setWindowTitle(tr("Video file or stream"));
    setMinimumWidth(520);
    auto* column = new QVBoxLayout(this);
    auto* explanation = new QLabel(tr("A video file, or the address of a camera in the network: rtsp://… or http://…"));
    explanation->setWordWrap(true);
    column->addWidget(explanation);
    auto* row = new QHBoxLayout;
    where_->setObjectName(QStringLiteral("video"));
    where_->setAccessibleName(tr("File or address"));
    where_->setToolTip(tr("Pictures are taken from there as if it were a webcam"));
    where_->setPlaceholderText(QStringLiteral("rtsp://192.168.1.20/stream"));
    row->addWidget(where_, 1);
    auto* browse = new QPushButton(tr("Browse …"));
    browse->setToolTip(tr("Choose a video file"));
    row->addWidget(browse);
    column->addLayout(row);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Open | QDialogButtonBox::Cancel);
    QPushButton* open = buttons->button(QDialogButtonBox::Open);
    open->setToolTip(tr("Take pictures from there"));
    open->setEnabled(false);
    buttons->button(QDialogButtonBox::Cancel)->setToolTip(tr("Stay with the camera that is chosen"));
    column->addWidget(buttons);
    connect(where_, &QLineEdit::textChanged, this, [this, open] { open->setEnabled(url().has_value()); });
    connect(browse, &QPushButton::clicked, this, [this] {
        const QString file = QFileDialog::getOpenFileName(
            this, tr("Video"), {}, tr("Videos (*.avi *.mkv *.mp4 *.mov *.webm *.ogv);;All files (*)"));
        if (!file.isEmpty())
            where_->setText(file);
    });
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
}

std::optional<QUrl> VideoDialog::url() const {
    return videoUrl(where_->text());
}

}  // namespace skincal
