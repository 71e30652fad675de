#pragma once

#include <QProcess>
#include <memory>

#include "core/device/line.h"

namespace skincal {

/// A program that speaks the protocol on its standard input and output: a bridge to a skin that has its own driver.
/// What it writes to its error output goes to ours, and its last line into the reason where it ends. When the
/// line is closed its input ends; half a second later it is asked to end, after another second made to.
class ProgramLine : public Line {
    Q_OBJECT
  public:
    /// @param command  program and arguments, split as splitCommand() does
    explicit ProgramLine(QString command, QObject* parent = nullptr);
    ~ProgramLine() override;

    void open() override;
    void close() override;
    void write(const QByteArray& bytes) override;
    /// 100 Mbit/s.
    [[nodiscard]] double bytesPerSecond() const override { return 12.5e6; }

  private:
    void fail(LineFault fault, const QString& detail);

    QString command_;
    std::unique_ptr<QProcess> process_;
    QByteArray lastError_;
};

}  // namespace skincal
