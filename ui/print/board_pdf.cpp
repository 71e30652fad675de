#include "ui/print/board_pdf.h"

#include <QCoreApplication>
#include <QFont>
#include <QFontMetricsF>
#include <QPageLayout>
#include <QPageSize>
#include <QPainter>
#include <QPdfWriter>
#include <QSaveFile>
#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace skincal {
namespace {

constexpr double kMargin_mm = 12;
constexpr double kFoot_mm = 22;  ///< ruler and text below the board
constexpr double kMetre_mm = 1000;

/// Gives the texts of this file their context.
class BoardPdf {
    Q_DECLARE_TR_FUNCTIONS(skincal::BoardPdf)
};

void rectangle(QPainter& painter, double x, double y, double width, double height) {
    painter.fillRect(QRectF(x, y, width, height), Qt::black);
}

void text(QPainter& painter, double x, double baseline, double height, const QString& words) {
    // Fonts come in whole pixels: drawn large, then made small.
    constexpr int kPixels = 100;
    QFont font;
    font.setPixelSize(kPixels);
    painter.save();
    painter.translate(x, baseline);
    painter.scale(height / kPixels, height / kPixels);
    painter.setFont(font);
    painter.setPen(Qt::black);
    painter.drawText(QPointF(0, 0), words);
    painter.restore();
}

void ruler(QPainter& painter, double x, double y, double length) {
    constexpr double kLine = 0.2;
    rectangle(painter, x - kLine / 2, y - kLine / 2, length + kLine, kLine);
    for (int mm = 0; mm <= static_cast<int>(length); ++mm) {
        const double tick = mm % 10 == 0 ? 3.5 : mm % 5 == 0 ? 2.5 : 1.5;
        rectangle(painter, x + mm - kLine / 2, y - tick, kLine, tick);
    }
}

QString describe(const BoardPlan& plan) {
    const QString size = QString::number(plan.square * kMetre_mm, 'g', 6);
    if (plan.kind == BoardKind::Chessboard)
        return BoardPdf::tr("Chessboard, %1 x %2 squares of %3 mm").arg(plan.columns).arg(plan.rows).arg(size);
    const std::string_view dictionary = name(plan.dictionary);
    return BoardPdf::tr("ChArUco, %1 x %2 squares of %3 mm, markers of %4 mm, %5")
        .arg(plan.columns)
        .arg(plan.rows)
        .arg(size, QString::number(plan.marker * kMetre_mm, 'g', 6),
             QString::fromLatin1(dictionary.data(), static_cast<qsizetype>(dictionary.size())));
}

}  // namespace

BoardSheet sheetFor(const BoardPlan& plan) {
    const double width = plan.width() * kMetre_mm + 2 * kMargin_mm;
    const double height = plan.height() * kMetre_mm + 2 * kMargin_mm + kFoot_mm;
    constexpr std::array<std::pair<double, double>, 5> kSheets{
        {{210, 297}, {297, 420}, {420, 594}, {594, 841}, {841, 1189}}};
    BoardSheet sheet{std::max(width, 2 * kMargin_mm + 60), height, 0, 0};
    for (const auto& [shorter, longer] : kSheets) {
        if (width <= longer && height <= shorter)
            sheet = {longer, shorter, 0, 0};
        else if (width <= shorter && height <= longer)
            sheet = {shorter, longer, 0, 0};
        else
            continue;
        break;
    }
    sheet.left_mm = (sheet.width_mm - plan.width() * kMetre_mm) / 2;
    sheet.top_mm = (sheet.height_mm - kFoot_mm - plan.height() * kMetre_mm) / 2;
    return sheet;
}

void paintBoard(QPainter& painter, const BoardPlan& plan) {
    const BoardSheet sheet = sheetFor(plan);
    // Smoothed edges of neighbours would let hair lines of white through.
    painter.setRenderHint(QPainter::Antialiasing, false);
    for (const BoardCell& cell : blackCells(plan))
        rectangle(painter, sheet.left_mm + cell.x * kMetre_mm, sheet.top_mm + cell.y * kMetre_mm,
                  cell.width * kMetre_mm, cell.height * kMetre_mm);
    constexpr double kText = 3;
    const double length = sheet.width_mm - 2 * kMargin_mm >= 100 ? 100 : 50;
    const double foot = sheet.height_mm - kMargin_mm - kFoot_mm + 12;
    ruler(painter, kMargin_mm, foot, length);
    text(painter, kMargin_mm, foot + 5, kText,
         BoardPdf::tr(
             "Printed without scaling this is %1 mm. If it measures otherwise, enter the squares' measured size.")
             .arg(length));
    text(painter, kMargin_mm, foot + 10, kText, describe(plan));
}

tl::expected<void, QString> writeBoardPdf(const std::filesystem::path& file, const BoardPlan& plan) {
    if (!plan.validate())
        throw std::logic_error("writeBoardPdf: plan out of range");
    const QString path = QString::fromStdString(file.string());
    QSaveFile output(path);
    if (!output.open(QIODevice::WriteOnly))
        return tl::unexpected(BoardPdf::tr("%1 can't be written: %2").arg(path, output.errorString()));
    const BoardSheet sheet = sheetFor(plan);
    {
        QPdfWriter writer(&output);
        constexpr int kResolution = 1200;
        constexpr double kInch_mm = 25.4;
        writer.setResolution(kResolution);
        writer.setTitle(describe(plan));
        writer.setPageLayout(QPageLayout(
            QPageSize(QSizeF(sheet.width_mm, sheet.height_mm), QPageSize::Millimeter, {}, QPageSize::ExactMatch),
            QPageLayout::Portrait, QMarginsF()));
        QPainter painter;
        if (!painter.begin(&writer))
            return tl::unexpected(BoardPdf::tr("%1 can't be written").arg(path));
        painter.scale(kResolution / kInch_mm, kResolution / kInch_mm);
        paintBoard(painter, plan);
        painter.end();
    }
    if (!output.commit())
        return tl::unexpected(BoardPdf::tr("%1 can't be written: %2").arg(path, output.errorString()));
    return {};
}

}  // namespace skincal
