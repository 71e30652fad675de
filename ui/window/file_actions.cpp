#include "ui/window/file_actions.h"

#include <QAction>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>
#include <QSettings>
#include <QToolBar>
#include <QToolButton>

namespace skincal {
namespace {

constexpr int kMostRecent = 8;
constexpr auto kKey = "recent";
constexpr auto kSuffix = ".skinrec";

}  // namespace

FileActions::FileActions(Session& session, QWidget& window) : QObject(&window), session_(session), window_(window) {
    connect(&session, &Session::opened, this, [this](const QString& directory) {
        file_ = directory;
        note(directory);
    });
    connect(&session, &Session::saved, this, &FileActions::note);
}

void FileActions::addTo(QToolBar& bar) {
    auto* open = bar.addAction(tr("Open …"));
    open->setShortcut(QKeySequence::Open);
    open->setToolTip(tr("Open a recording (a .skinrec folder); one can also be dropped on the window"));
    connect(open, &QAction::triggered, this, [this] {
        const QString directory = QFileDialog::getExistingDirectory(&window_, tr("Open a recording"));
        if (!directory.isEmpty())
            this->open(directory);
    });
    auto* recent = new QToolButton;
    recent->setObjectName(QStringLiteral("recent"));
    recent->setText(tr("Recent"));
    recent->setShortcut(QKeySequence(Qt::CTRL | Qt::Key_R));
    recent->setToolTip(tr("Recordings that were opened or saved lately (Ctrl+R)"));
    recent->setPopupMode(QToolButton::InstantPopup);
    auto* menu = new QMenu(recent);
    menu->setToolTipsVisible(true);
    recent->setMenu(menu);
    connect(menu, &QMenu::aboutToShow, this, [this, menu] { fill(*menu); });
    bar.addWidget(recent);
    auto* save = bar.addAction(tr("Save"));
    save->setShortcut(QKeySequence::Save);
    save->setToolTip(tr("Save what was measured and decided as a recording (a .skinrec folder)"));
    connect(save, &QAction::triggered, this, [this] { this->save(false); });
    auto* saveAs = bar.addAction(tr("Save as …"));
    saveAs->setShortcut(QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_S));
    saveAs->setToolTip(tr("Save in another place, and go on there"));
    connect(saveAs, &QAction::triggered, this, [this] { this->save(true); });
}

void FileActions::keepRecentIn(const QString& iniFile) {
    iniFile_ = iniFile;
    recent_ = QSettings(iniFile_, QSettings::IniFormat).value(QLatin1String(kKey)).toStringList();
}

void FileActions::open(const QString& directory) {
    emit said(tr("Reading %1 …").arg(directory));
    session_.open(directory);
}

void FileActions::save(bool elsewhere) {
    if (!session_.decisions().camera) {
        emit complained(tr("A recording needs the camera's intrinsics: give them before saving."), Step::Camera);
        return;
    }
    if (file_.isEmpty() || elsewhere) {
        QString chosen =
            QFileDialog::getSaveFileName(&window_, tr("Save as a recording"), QStringLiteral("skin.skinrec"));
        if (chosen.isEmpty())
            return;
        if (!chosen.endsWith(QLatin1String(kSuffix)))
            chosen += QLatin1String(kSuffix);
        file_ = chosen;
    }
    session_.save(file_);
}

void FileActions::setFile(const QString& directory) {
    if (directory.isEmpty())
        recent_.removeAll(QFileInfo(file_).absoluteFilePath());
    file_ = directory;
}

QStringList FileActions::recent() const {
    QStringList there;
    for (const QString& directory : recent_) {
        if (QFileInfo::exists(directory))
            there << directory;
    }
    return there;
}

void FileActions::note(const QString& directory) {
    const QString path = QFileInfo(directory).absoluteFilePath();
    recent_.removeAll(path);
    recent_.prepend(path);
    while (recent_.size() > kMostRecent)
        recent_.removeLast();
    if (!iniFile_.isEmpty())
        QSettings(iniFile_, QSettings::IniFormat).setValue(QLatin1String(kKey), recent_);
}

void FileActions::fill(QMenu& menu) {
    menu.clear();
    for (const QString& directory : recent()) {
        auto* action = menu.addAction(QDir(directory).dirName(), this, [this, directory] { open(directory); });
        action->setToolTip(QDir::toNativeSeparators(directory));
    }
    if (menu.isEmpty())
        menu.addAction(tr("None yet"))->setEnabled(false);
}

}  // namespace skincal
