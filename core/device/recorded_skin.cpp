#include "core/device/recorded_skin.h"

#include <QPointer>

namespace skincal {

RecordedSkin::RecordedSkin(QString name, Skin skin, QObject* parent)
    : SkinDevice(parent), name_(std::move(name)), skin_(std::move(skin)) {}

void RecordedSkin::later(std::function<void()> what) {
    const auto call = [this, session = session_, what = std::move(what)] {
        if (session == session_)
            what();
    };
    QMetaObject::invokeMethod(this, call, Qt::QueuedConnection);
}

void RecordedSkin::open() {
    if (open_)
        return;
    open_ = true;
    ++session_;
    later([this] { emit opened(); });
}

void RecordedSkin::close() {
    if (!open_)
        return;
    open_ = false;
    ++session_;
    later([this] { emit closed(); });
}

void RecordedSkin::explore() {
    if (!open_) {
        later([this] { emit failed(tr("the skin is not open")); });
        return;
    }
    later([this] {
        const QPointer<RecordedSkin> self(this);
        const std::uint64_t session = session_;
        for (const SkinModule& module : skin_.modules) {
            emit moduleFound(module.id);
            if (!self || session != session_)
                return;
        }
        emit explored(skin_);
    });
}

void RecordedSkin::streamAcceleration(bool /*on*/) {}

void RecordedSkin::streamTactile(bool /*on*/) {}

std::uint64_t RecordedSkin::light(const std::vector<LitModule>& /*lit*/) {
    ++token_;
    if (open_)
        later([this, token = token_] { emit lightShown(token); });
    return token_;
}

}  // namespace skincal
