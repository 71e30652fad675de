#pragma once

#include <QString>
#include <QStringList>
#include <tl/expected.hpp>

namespace skincal {

/// A program and its arguments, quoted as in a shell: 'as it is', "with spaces", \  for a single character. Nothing
/// else of a shell: no variables, wildcards or pipes. At least one word. The error says what is wrong with the quotes.
[[nodiscard]] tl::expected<QStringList, QString> splitCommand(const QString& command);

}  // namespace skincal
