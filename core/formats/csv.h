#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/formats/file_error.h"

namespace skincal {

/// Reads a CSV of plain fields (no quotes: our files hold numbers and names) row by row. CRLF and a byte order mark are
/// tolerated, empty lines skipped. Throws FileErrorException (json_cursor.h) with the row, counted as an editor does.
class CsvReader {
  public:
    /// Reads the header. Columns in `required` must be there, in any order; others are remembered for optional().
    CsvReader(std::string_view text, std::filesystem::path file, const std::vector<std::string>& required);

    /// Goes to the next row; false at the end.
    bool next();

    [[nodiscard]] std::string_view text(std::string_view column) const;
    [[nodiscard]] double number(std::string_view column) const;  ///< finite
    [[nodiscard]] long long integer(std::string_view column, long long low, long long high) const;
    /// Nothing where the column or its field is missing.
    [[nodiscard]] std::optional<double> optionalNumber(std::string_view column) const;
    [[noreturn]] void fail(std::string_view column, const std::string& problem) const;

  private:
    bool readLine(std::string_view& line);
    [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const;

    std::string_view rest_;
    std::filesystem::path file_;
    std::vector<std::string> columns_;
    std::vector<std::string_view> fields_;
    std::size_t row_ = 0;
};

}  // namespace skincal
