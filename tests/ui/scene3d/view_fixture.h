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

/// Something presses on each of these modules, the first the hardest.
inline std::vector<ContactMark> contactsOn(const BodyViewWidget& view, std::initializer_list<std::uint32_t> modules) {
    std::vector<ContactMark> contacts;
    double length = 0.35 * view.layoutShown().radius;
    for (const std::uint32_t module : modules) {
        const Isometry3d& T_s_u = view.layoutShown().find(ModuleId(module))->T_s_u;
        contacts.push_back({T_s_u.translation(), T_s_u.linear().col(2), length});
        length *= 0.7;
    }
    return contacts;
}

}  // namespace skincal
