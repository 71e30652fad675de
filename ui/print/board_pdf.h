#pragma once

#include <QString>
#include <filesystem>
#include <tl/expected.hpp>

#include "core/camera_calibration/board_plan.h"

class QPainter;

namespace skincal {

/// Sheet on which a board is printed.
struct BoardSheet {
    double width_mm = 0;
    double height_mm = 0;
    double left_mm = 0;  ///< of the board's squares
    double top_mm = 0;
};

/// A landscape or upright A4 sheet where the board fits with a margin of 12 mm and room for the ruler, else the
/// smallest of A3, A2, A1 and A0 that holds it, else a sheet of the board's own size.
[[nodiscard]] BoardSheet sheetFor(const BoardPlan& plan);

/// Draws the board, a ruler of 100 mm (50 mm on small sheets) and what the board is, with lengths in millimetres from
/// the sheet's top-left corner. A widget may scale the painter first, to show the sheet.
void paintBoard(QPainter& painter, const BoardPlan& plan);

/// The board as a PDF of one page, at its true size when printed without scaling: the ruler shows it. Vector graphics,
/// so any printer's resolution is used. Atomic: an old file stays until the new one is whole. Needs a QGuiApplication.
/// The error is a sentence for people. Throws std::logic_error for a plan that isn't valid.
[[nodiscard]] tl::expected<void, QString> writeBoardPdf(const std::filesystem::path& file, const BoardPlan& plan);

}  // namespace skincal
