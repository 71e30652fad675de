#include "core/rig/pseudo_terminal.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <QFile>
#include <QFileInfo>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace skincal {
namespace {

constexpr qsizetype kMostWaiting = 1 << 20;

QString systemError(const char* what) {
    return QStringLiteral("%1: %2").arg(QLatin1String(what), QString::fromLocal8Bit(std::strerror(errno)));
}

}  // namespace

PseudoTerminal::~PseudoTerminal() {
    close();
}

QString PseudoTerminal::open(const QString& link) {
    close();
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) {
        const QString why = systemError("no pseudo-terminal can be made");
        close();
        return why;
    }
    std::array<char, 128> path{};
    if (::ptsname_r(master_, path.data(), path.size()) != 0)
        return systemError("the pseudo-terminal has no name");
    name_ = QString::fromLocal8Bit(path.data());
    slave_ = ::open(path.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    if (slave_ >= 0 && ::tcgetattr(slave_, &settings) == 0) {
        ::cfmakeraw(&settings);
        ::tcsetattr(slave_, TCSANOW, &settings);
    }
    if (!link.isEmpty()) {
        // Of one that was killed the link leads nowhere any more.
        if (QFileInfo(link).isSymLink() && QFileInfo::exists(link)) {
            close();
            return QStringLiteral("%1 is another port's name already").arg(link);
        }
        if (QFileInfo(link).isSymLink())
            QFile::remove(link);
        if (!QFile::link(name_, link)) {
            close();
            return QStringLiteral("can't make the link %1").arg(link);
        }
        link_ = link;
    }
    readable_ = std::make_unique<QSocketNotifier>(master_, QSocketNotifier::Read);
    connect(readable_.get(), &QSocketNotifier::activated, this, [this] {
        QByteArray bytes(65536, Qt::Uninitialized);
        const auto count = ::read(master_, bytes.data(), static_cast<std::size_t>(bytes.size()));
        if (count <= 0)
            return;
        bytes.truncate(count);
        emit received(bytes);
    });
    writable_ = std::make_unique<QSocketNotifier>(master_, QSocketNotifier::Write);
    writable_->setEnabled(false);
    connect(writable_.get(), &QSocketNotifier::activated, this, &PseudoTerminal::flush);
    return {};
}

void PseudoTerminal::close() {
    // They may be what called this: gone later, but deaf from now on.
    for (auto* notifier : {&readable_, &writable_}) {
        if (!*notifier)
            continue;
        (*notifier)->setEnabled(false);
        (*notifier)->disconnect(this);
        notifier->release()->deleteLater();
    }
    if (slave_ >= 0)
        ::close(slave_);
    if (master_ >= 0)
        ::close(master_);
    slave_ = -1;
    master_ = -1;
    waiting_.clear();
    if (!link_.isEmpty())
        QFile::remove(link_);
    link_.clear();
}

void PseudoTerminal::write(const QByteArray& bytes) {
    if (master_ < 0 || waiting_.size() > kMostWaiting)
        return;
    waiting_ += bytes;
    flush();
}

void PseudoTerminal::flush() {
    while (master_ >= 0 && !waiting_.isEmpty()) {
        const auto count = ::write(master_, waiting_.constData(), static_cast<std::size_t>(waiting_.size()));
        if (count <= 0)
            break;
        waiting_.remove(0, count);
    }
    if (writable_)
        writable_->setEnabled(!waiting_.isEmpty());
}

}  // namespace skincal
