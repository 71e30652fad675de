#include "core/device/program_line.h"

#include <QTimer>
#include <cstdio>

#include "core/device/split_command.h"

namespace skincal {

ProgramLine::ProgramLine(QString command, QObject* parent) : Line(parent), command_(std::move(command)) {}

ProgramLine::~ProgramLine() {
    close();
}

void ProgramLine::open() {
    close();
    lastError_.clear();
    process_ = std::make_unique<QProcess>();
    QProcess* process = process_.get();
    connect(process, &QProcess::started, this, [this] { emit opened(); });
    connect(process, &QProcess::readyReadStandardOutput, this,
            [this] { emit received(process_->readAllStandardOutput()); });
    connect(process, &QProcess::readyReadStandardError, this, [this] {
        const QByteArray text = process_->readAllStandardError();
        std::fwrite(text.constData(), 1, static_cast<std::size_t>(text.size()), stderr);
        const QList<QByteArray> lines = text.trimmed().split('\n');
        lastError_ = lines.back();
    });
    connect(process, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
        if (error == QProcess::FailedToStart)
            QTimer::singleShot(0, process_.get(), [this] { fail(LineFault::NoProgram, process_->errorString()); });
    });
    connect(process, &QProcess::finished, this, [this](int code) {
        const QString said = QString::fromUtf8(lastError_);
        const QString detail = said.isEmpty() ? tr("exit code %1").arg(code) : said;
        QTimer::singleShot(0, process_.get(), [this, detail] { fail(LineFault::Ended, detail); });
    });
    const auto words = splitCommand(command_);
    if (!words) {
        QTimer::singleShot(0, process, [this, why = words.error()] { fail(LineFault::NoProgram, why); });
        return;
    }
    process->start(words->front(), words->mid(1));
}

void ProgramLine::close() {
    if (!process_)
        return;
    QProcess* process = process_.release();
    process->disconnect(this);
    process->setParent(this);  // a thread that ends deletes nothing later
    if (process->state() == QProcess::NotRunning) {
        process->deleteLater();
        return;
    }
    // Its input ends, which tells it to put things in order; who doesn't hear that is told more plainly.
    process->closeWriteChannel();
    if (!process->waitForFinished(500))
        process->terminate();
    if (!process->waitForFinished(1000)) {
        process->kill();
        process->waitForFinished(1000);
    }
    process->deleteLater();
}

void ProgramLine::write(const QByteArray& bytes) {
    if (process_ && process_->state() == QProcess::Running)
        process_->write(bytes);
}

void ProgramLine::fail(LineFault fault, const QString& detail) {
    close();
    emit failed(fault, detail);
}

}  // namespace skincal
