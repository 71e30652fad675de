#pragma once

#include <QDateTime>
#include <QLockFile>
#include <QObject>
#include <QTimer>
#include <memory>
#include <vector>

#include "core/session/session.h"

namespace skincal {

/// A session that ended before it was saved.
struct KeptSession {
    QString directory;  ///< a recording, perhaps only begun
    QDateTime time;     ///< of its last change
};

/// Keeps what was measured and decided on the disk while nobody saves it: a crash or an empty battery costs a second of
/// work at most. Each document of a running program has a directory of its own, which goes once it is saved; what was
/// not saved when another was opened, or when the program ended, can be opened again.
class SessionKeeper : public QObject {
    Q_OBJECT
  public:
    /// @param folder  of all kept sessions; made where it is missing. Where it can't be, nothing is kept, and failed()
    /// says so once.
    SessionKeeper(Session& session, const QString& folder, QObject* parent = nullptr);
    ~SessionKeeper() override;

    /// What programs that have ended left, the newest first. What none of them could have written is not listed.
    [[nodiscard]] std::vector<KeptSession> kept() const;
    /// Forgets one of them for good.
    static void forget(const KeptSession& session);

    /// Where this program keeps its own; for tests.
    [[nodiscard]] const QString& directory() const { return directory_; }
    /// Writes now what waits to be written.
    void flush();

  signals:
    void failed(const QString& why);

  private:
    void begin();
    void sessionChanged();
    void removeOwn();

    Session& session_;
    QString folder_;
    QString directory_;
    std::unique_ptr<QLockFile> lock_;
    QTimer timer_;
};

}  // namespace skincal
