#pragma once

#include <QString>
#include <QTimer>
#include <chrono>
#include <functional>

namespace skincal {

/// Something that is needed was lost, a skin or a camera. It is waited for, but not for ever.
class Absence {
  public:
    /// @param tryAgain  every few seconds while it lasts: not all that comes back says so
    /// @param giveUp    once it has lasted as long as `patience`
    Absence(std::chrono::seconds patience, std::function<void()> tryAgain, std::function<void()> giveUp);

    /// It begins, or lasts and there are newer words for it.
    /// @return whether it has just begun
    bool note(const QString& why);
    /// @return whether it lasted until now
    bool end();
    [[nodiscard]] bool isLasting() const { return patience_.isActive(); }
    /// The newest words.
    [[nodiscard]] const QString& why() const { return why_; }

  private:
    QString why_;
    QTimer patience_;
    QTimer again_;
};

}  // namespace skincal
