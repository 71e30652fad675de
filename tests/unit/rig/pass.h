#pragma once

#include <QEventLoop>

#include "core/rig/rig_clock.h"

namespace skincal {

/// Runs the event loop until so much simulated time has passed, and everything that was asked for by then has happened.
inline void pass(RigClock& clock, RigClock::Time passed) {
    QEventLoop loop;
    const RigClock::Time end = clock.now() + passed;
    // Asked for twice: after what others have asked for by then for the same time.
    clock.at(end, &loop, [&] { clock.at(end, &loop, [&loop] { loop.quit(); }); });
    // Inside the handler of a posted event, GLib's dispatcher sleeps on whatever was posted together with that one
    // until something else is posted: for ever, where that is the picture that holds the clock.
    QMetaObject::invokeMethod(
        &loop, [] {}, Qt::QueuedConnection);
    loop.exec();
}

/// Runs the event loop for what was posted already; no simulated time passes that nobody asked for.
inline void settle() {
    QEventLoop loop;
    QTimer::singleShot(0, &loop, &QEventLoop::quit);
    loop.exec();
}

}  // namespace skincal
