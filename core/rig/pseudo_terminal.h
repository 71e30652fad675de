#pragma once

#include <QByteArray>
#include <QObject>
#include <QSocketNotifier>
#include <QString>
#include <memory>

namespace skincal {

/// A pseudo-terminal whose other end a program opens like a serial port. Unix only.
class PseudoTerminal : public QObject {
    Q_OBJECT
  public:
    using QObject::QObject;
    ~PseudoTerminal() override;

    /// @param link  a symbolic link to be made to it, so that it has the same name each time; empty for none
    /// Returns what went wrong, empty where nothing did.
    [[nodiscard]] QString open(const QString& link = {});
    /// For who has it open that is as if it were unplugged.
    void close();
    [[nodiscard]] bool isOpen() const { return master_ >= 0; }
    /// What to open: the link where there is one.
    [[nodiscard]] QString name() const { return link_.isEmpty() ? name_ : link_; }
    /// What nobody reads is lost in the end, as on a wire.
    void write(const QByteArray& bytes);

  signals:
    void received(const QByteArray& bytes);

  private:
    void flush();

    int master_ = -1;
    int slave_ = -1;  ///< held open, else reading fails while nobody else has it open
    QString name_;
    QString link_;
    QByteArray waiting_;
    std::unique_ptr<QSocketNotifier> readable_;
    std::unique_ptr<QSocketNotifier> writable_;
};

}  // namespace skincal
