#pragma once

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QEventLoop>
#include <QTimer>
#include <functional>

namespace skincal::test {

/// Runs the event loop until something is so. False where it never is.
[[nodiscard]] inline bool waitFor(const std::function<bool()>& isSo) {
    constexpr int kPatience_ms = 120'000;  // on machines that do much else
    QElapsedTimer timer;
    timer.start();
    QTimer wake;  // where nothing happens any more
    wake.start(1000);
    while (!isSo()) {
        if (timer.elapsed() > kPatience_ms)
            return false;
        QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents);
    }
    return true;
}

}  // namespace skincal::test
