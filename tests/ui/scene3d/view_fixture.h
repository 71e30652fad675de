#pragma once

#include <QApplication>
#include <QElapsedTimer>
#include <memory>

#include "ui/scene3d/body_view_widget.h"

namespace skincal {

/// Lets the event loop run.
inline void spin(int milliseconds) {
    QElapsedTimer timer;
    timer.start();
    do
        QApplication::processEvents(QEventLoop::AllEvents, 10);
    while (timer.elapsed() < milliseconds);
}

/// A view of 480x360, on the screen.
inline std::unique_ptr<BodyViewWidget> shownView() {
    auto view = std::make_unique<BodyViewWidget>();
    view->resize(480, 360);
    view->show();
    spin(80);
    return view;
}

}  // namespace skincal
