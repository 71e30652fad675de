#pragma once

#include <QCoreApplication>
#include <QString>
#include <QStringList>
#include <string>

namespace skincal::html {

struct ReportText {
    Q_DECLARE_TR_FUNCTIONS(ReportText)
};

/// Text from files is no markup.
[[nodiscard]] inline QString escaped(const std::string& text) {
    return QString::fromStdString(text).toHtmlEscaped();
}

[[nodiscard]] inline QString row(const QStringList& cells, const QString& tag = QStringLiteral("td")) {
    QString html = QStringLiteral("<tr>");
    for (const QString& cell : cells)
        html += QStringLiteral("<%1>%2</%1>").arg(tag, cell);
    return html + QStringLiteral("</tr>\n");
}

[[nodiscard]] inline QString table(const QStringList& heads, const QString& rows) {
    return QStringLiteral("<table border=\"1\" cellspacing=\"0\" cellpadding=\"3\">\n") +
           (heads.isEmpty() ? QString() : row(heads, QStringLiteral("th"))) + rows + QStringLiteral("</table>\n");
}

[[nodiscard]] inline QString heading(const QString& text) {
    return QStringLiteral("<h2>%1</h2>\n").arg(text);
}

}  // namespace skincal::html
