#include "app/absence.h"

namespace skincal {
namespace {

constexpr std::chrono::seconds kAgain{3};

}  // namespace

Absence::Absence(std::chrono::seconds patience, std::function<void()> tryAgain, std::function<void()> giveUp) {
    patience_.setSingleShot(true);
    patience_.setInterval(patience);
    again_.setInterval(kAgain);
    QObject::connect(&again_, &QTimer::timeout, &again_, std::move(tryAgain));
    QObject::connect(&patience_, &QTimer::timeout, &patience_, [this, giveUp = std::move(giveUp)] {
        again_.stop();
        giveUp();
    });
}

bool Absence::note(const QString& why) {
    why_ = why;
    if (isLasting())
        return false;
    patience_.start();
    again_.start();
    return true;
}

bool Absence::end() {
    const bool lasted = isLasting();
    patience_.stop();
    again_.stop();
    return lasted;
}

}  // namespace skincal
