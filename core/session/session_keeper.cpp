#include "core/session/session_keeper.h"

#include <QCoreApplication>
#include <QDir>
#include <QFileInfo>
#include <chrono>

namespace skincal {
namespace {

constexpr std::chrono::milliseconds kCalm{1000};  // changes that follow each other quicker are written once
constexpr auto kSuffix = ".skinrec";

QString lockOf(const QString& directory) {
    return directory + QStringLiteral(".lock");
}

}  // namespace

SessionKeeper::SessionKeeper(Session& session, const QString& folder, QObject* parent)
    : QObject(parent), session_(session), folder_(folder) {
    QDir().mkpath(folder_);
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, [this] { session_.saveCopy(directory_); });
    connect(&session, &Session::modifiedChanged, this, &SessionKeeper::sessionChanged);
    connect(&session, &Session::saved, this, &SessionKeeper::removeOwn);
    // A copy that was on its way while the session was saved has come too late.
    connect(&session, &Session::copied, this, &SessionKeeper::removeOwn);
    // What was not saved before is another document: it stays.
    connect(&session, &Session::opened, this, [this] {
        if (QDir(directory_).exists())
            begin();
    });
    begin();
}

void SessionKeeper::begin() {
    const QString stem =
        QStringLiteral("%1-%2").arg(QDateTime::currentDateTime().toString(QStringLiteral("yyyyMMdd-hhmmss-zzz")));
    directory_ = QDir(folder_).filePath(stem.arg(QCoreApplication::applicationPid()) + QLatin1String(kSuffix));
    lock_ = std::make_unique<QLockFile>(lockOf(directory_));
    lock_->setStaleLockTime(0);  // for as long as the program runs
    if (lock_->tryLock(0))
        return;
    lock_.reset();
    const QString why = tr("Unsaved work can't be kept in %1: it may not be written to.").arg(folder_);
    QMetaObject::invokeMethod(
        this, [this, why] { emit failed(why); }, Qt::QueuedConnection);
}

SessionKeeper::~SessionKeeper() {
    flush();
}

void SessionKeeper::sessionChanged() {
    if (!session_.isModified())
        timer_.stop();
    else if (lock_ && !timer_.isActive() && !session_.measured().skin.modules.empty())
        timer_.start(kCalm);
}

void SessionKeeper::removeOwn() {
    if (!session_.isModified())
        QDir(directory_).removeRecursively();
}

void SessionKeeper::flush() {
    if (!timer_.isActive())
        return;
    timer_.stop();
    session_.saveCopy(directory_);
}

std::vector<KeptSession> SessionKeeper::kept() const {
    std::vector<KeptSession> sessions;
    const QDir folder(folder_);
    for (const QFileInfo& entry :
         folder.entryInfoList({QStringLiteral("*%1").arg(QLatin1String(kSuffix))}, QDir::Dirs)) {
        const QFileInfo recording(QDir(entry.filePath()).filePath(QStringLiteral("recording.json")));
        if (entry.filePath() == directory_ || !recording.exists())
            continue;
        QLockFile lock(lockOf(entry.filePath()));
        lock.setStaleLockTime(0);
        if (!lock.tryLock(0))
            continue;  // its program runs
        sessions.push_back({entry.filePath(), recording.lastModified()});
    }
    std::sort(sessions.begin(), sessions.end(),
              [](const KeptSession& a, const KeptSession& b) { return a.time > b.time; });
    return sessions;
}

void SessionKeeper::forget(const KeptSession& session) {
    QDir(session.directory).removeRecursively();
    QFile::remove(lockOf(session.directory));
}

}  // namespace skincal
