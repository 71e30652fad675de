#include "core/device/split_command.h"

#include <glib.h>

namespace skincal {

// QProcess::splitCommand() knows double quotes alone, wordexp() replaces variables and wildcards, too.
tl::expected<QStringList, QString> splitCommand(const QString& command) {
    gchar** words = nullptr;
    GError* error = nullptr;
    if (g_shell_parse_argv(command.toUtf8().constData(), nullptr, &words, &error) == FALSE) {
        const QString why = QString::fromUtf8(error->message);
        g_error_free(error);
        return tl::unexpected(why);
    }
    QStringList list;
    for (gchar** word = words; *word != nullptr; ++word)
        list << QString::fromUtf8(*word);
    g_strfreev(words);
    return list;
}

}  // namespace skincal
