#include "app/qt_messages.h"

#include <QString>
#include <algorithm>
#include <array>

namespace skincal {
namespace {

constexpr std::array kHidden{"PulseAudioService: pa_context_connect() failed",
                             "QStandardPaths: XDG_RUNTIME_DIR not set"};
QtMessageHandler print = nullptr;

void filter(QtMsgType type, const QMessageLogContext& context, const QString& message) {
    const bool isHidden = std::any_of(kHidden.begin(), kHidden.end(),
                                      [&](const char* text) { return message.startsWith(QLatin1String(text)); });
    if (!isHidden)
        print(type, context, message);
}

}  // namespace

void hideWhatQtSaysOfSound() {
    print = qInstallMessageHandler(filter);
}

}  // namespace skincal
