#include "ui/presenters/camera_words.h"

#include <QCoreApplication>
#include <QStringList>
#include <algorithm>

namespace skincal {
namespace {

struct CameraWords {
    Q_DECLARE_TR_FUNCTIONS(CameraWords)
};

QString nameOf(CameraControl control) {
    switch (control) {
        case CameraControl::Exposure:
            return CameraWords::tr("exposure");
        case CameraControl::Gain:
            return CameraWords::tr("gain");
        case CameraControl::Focus:
            return CameraWords::tr("focus");
        default:
            return CameraWords::tr("white balance");
    }
}

QString reasonOf(ControlState::Outcome outcome) {
    using Outcome = ControlState::Outcome;
    switch (outcome) {
        case Outcome::NotOffered:
            return CameraWords::tr("the camera has no control for it");
        case Outcome::Automatic:
            return CameraWords::tr("it stays automatic");
        case Outcome::Refused:
            return CameraWords::tr("the camera refuses");
        default:
            return CameraWords::tr("its control cannot be reached");
    }
}

QString nameOf(FrameFault fault) {
    switch (fault) {
        case FrameFault::Empty:
            return CameraWords::tr("unreadable");
        case FrameFault::WrongSize:
            return CameraWords::tr("of another size");
        case FrameFault::TestPicture:
            return CameraWords::tr("test pictures");
        case FrameFault::Stale:
            return CameraWords::tr("too old");
        case FrameFault::RepeatedContent:
            return CameraWords::tr("the same as the one before");
        default:
            return CameraWords::tr("out of order");
    }
}

QString groupWords() {
    return CameraWords::tr("Run \"sudo usermod -aG video $USER\", then log out and in again.");
}

QString listOf(const QStringList& names) {
    return names.join(QStringLiteral(", "));
}

}  // namespace

QString cameraWords(const CameraFailure& failure) {
    const QString& where = failure.where;
    const bool isNode = where.startsWith(QStringLiteral("/dev/"));
    switch (failure.trouble) {
        case CameraTrouble::NotPluggedIn:
            return CameraWords::tr("The camera is not plugged in: plug it in, and its picture appears by itself.");
        case CameraTrouble::Unplugged:
            return CameraWords::tr("The camera was unplugged: plug it in again, and it goes on by itself.");
        case CameraTrouble::NoFirstPicture:
            return CameraWords::tr(
                "The camera gives no pictures: unplug it and plug it in again, into a port of the computer rather "
                "than a hub, or choose a smaller picture.");
        case CameraTrouble::Silent:
            return CameraWords::tr(
                "The camera has stopped giving pictures: check its cable, or unplug it and plug it in again.");
        case CameraTrouble::Frozen:
            return CameraWords::tr(
                "The camera gives the same picture again and again: take off its lid or cover, or unplug it and "
                "plug it in again.");
        case CameraTrouble::TestPicture:
            return CameraWords::tr("A test picture came in the place of the camera's: it is gone. Plug it in again.");
        case CameraTrouble::WrongSize:
            return CameraWords::tr(
                "The camera gives pictures of another size than asked for: choose another resolution.");
        case CameraTrouble::Late:
            return CameraWords::tr(
                "The pictures come more than a second late: choose a smaller resolution, or close other programs.");
        case CameraTrouble::Unsteady:
            return CameraWords::tr("The times of the camera's pictures do not rise: unplug it and plug it in again.");
        case CameraTrouble::Unreadable:
            return CameraWords::tr(
                "The camera's pictures are in a format that cannot be read: choose another resolution.");
        case CameraTrouble::Forbidden:
            return isNode ? CameraWords::tr("You are not allowed to open the camera %1. ").arg(where) + groupWords()
                          : CameraWords::tr("You are not allowed to read %1: run \"chmod u+r\" on it.").arg(where);
        case CameraTrouble::Busy:
            return CameraWords::tr("Another program uses the camera: close it. \"fuser -v %1\" names it.").arg(where);
        case CameraTrouble::CannotOpen:
            return CameraWords::tr("The camera cannot be opened (%1): unplug it and plug it in again.")
                .arg(failure.detail);
        case CameraTrouble::Missing:
            return CameraWords::tr("There is no file %1: choose another.").arg(where);
        case CameraTrouble::CannotPlay:
            return failure.detail.isEmpty()
                       ? CameraWords::tr("%1 cannot be played: check the address, or that it is a video.").arg(where)
                       : CameraWords::tr("%1 cannot be played (%2): check the address, or that it is a video.")
                             .arg(where, failure.detail);
        default:
            return CameraWords::tr("%1 is over: choose it again to see it from the beginning.").arg(where);
    }
}

QString failureWords(const FrameSource& source, const QString& why) {
    const auto failure = source.failure();
    return failure ? cameraWords(*failure) : why;
}

QString forbiddenWords(const QStringList& nodes) {
    if (nodes.isEmpty())
        return {};
    return CameraWords::tr("There is a camera that you are not allowed to open (%1). ").arg(listOf(nodes)) +
           groupWords();
}

QString controlWords(const std::vector<ControlState>& controls) {
    QStringList locked;
    QString open;
    for (const ControlState& state : controls) {
        if (state.outcome == ControlState::Outcome::Locked)
            locked << nameOf(state.control);
    }
    // Those of one reason together.
    for (const auto outcome : {ControlState::Outcome::Automatic, ControlState::Outcome::Refused,
                               ControlState::Outcome::NotOffered, ControlState::Outcome::NoAccess}) {
        QStringList names;
        for (const ControlState& state : controls) {
            if (state.outcome == outcome)
                names << nameOf(state.control);
        }
        if (!names.isEmpty())
            open += CameraWords::tr(" Not held: %1 (%2).").arg(listOf(names), reasonOf(outcome));
    }
    QString text = locked.isEmpty() ? QString() : CameraWords::tr("Held still: %1.").arg(listOf(locked));
    text += open;
    return text.trimmed();
}

bool mayBrightnessChange(const std::vector<ControlState>& controls) {
    using Outcome = ControlState::Outcome;
    return std::any_of(controls.begin(), controls.end(), [](const ControlState& state) {
        return (state.control == CameraControl::Exposure && state.outcome != Outcome::Locked) ||
               (state.control == CameraControl::Gain &&
                (state.outcome == Outcome::Automatic || state.outcome == Outcome::Refused));
    });
}

QString brightnessWords() {
    return CameraWords::tr(
        "The camera may change its exposure in the midst of a scan: keep the light even, and scan a view again where "
        "few "
        "modules were found");
}

QString refusedWords(const std::array<std::uint64_t, kFrameFaults>& refused) {
    QStringList parts;
    for (std::size_t k = 0; k < refused.size(); ++k) {
        if (refused[k] > 0)
            parts << CameraWords::tr("%1 %2").arg(refused[k]).arg(nameOf(static_cast<FrameFault>(k)));
    }
    return parts.isEmpty() ? QString() : CameraWords::tr("Pictures not used: %1.").arg(listOf(parts));
}

}  // namespace skincal
