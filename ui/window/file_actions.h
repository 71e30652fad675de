#pragma once

#include <QObject>
#include <QStringList>

#include "core/procedure/steps.h"
#include "core/session/session.h"

class QMenu;
class QToolBar;

namespace skincal {

/// Opening and saving recordings, and those that were lately: buttons, dialogs, and where the document lies.
class FileActions : public QObject {
    Q_OBJECT
  public:
    /// @param window  in front of which dialogs appear, and whose child this becomes.
    FileActions(Session& session, QWidget& window);

    void addTo(QToolBar& bar);
    /// The list of recent recordings is kept there from now on, beyond the end of the program.
    void keepRecentIn(const QString& iniFile);

    void open(const QString& directory);
    /// Where the document lies, or to where the operator says.
    void save(bool elsewhere);
    /// Where the document lies; empty where it has no place yet.
    void setFile(const QString& directory);

    /// The newest first; those that are no longer there are left out.
    [[nodiscard]] QStringList recent() const;

  signals:
    void complained(const QString& why, skincal::Step step);
    void said(const QString& message);

  private:
    void note(const QString& directory);
    void fill(QMenu& menu);

    Session& session_;
    QWidget& window_;
    QString file_;
    QString iniFile_;
    QStringList recent_;
};

}  // namespace skincal
