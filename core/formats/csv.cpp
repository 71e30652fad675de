#include "core/formats/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/formats/json_cursor.h"

namespace skincal {
namespace {

/// A row of nothing but commas would otherwise take sixteen times its size in memory.
constexpr std::size_t kMaxColumns = 1000;

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> fields;
    for (;;) {
        const auto comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos || fields.size() > kMaxColumns)
            return fields;
        line.remove_prefix(comma + 1);
    }
}

std::string shown(std::string_view text) {
    return text.size() <= 40 ? std::string(text) : std::string(text.substr(0, 37)) + "…";
}

}  // namespace

CsvReader::CsvReader(std::string_view text, std::filesystem::path file, const std::vector<std::string>& required)
    : rest_(text), file_(std::move(file)) {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF")
        rest_.remove_prefix(3);
    std::string_view header;
    if (!readLine(header))
        throw FileErrorException{{file_, "row 1", fmt::format("expected a header {}", fmt::join(required, ","))}};
    for (const std::string_view column : split(header))
        columns_.emplace_back(column);
    if (columns_.size() > kMaxColumns)
        throw FileErrorException{
            {file_, fmt::format("row {}", row_), fmt::format("expected at most {} columns", kMaxColumns)}};
    for (const std::string& column : required) {
        if (std::count(columns_.begin(), columns_.end(), column) != 1)
            throw FileErrorException{
                {file_, fmt::format("row {}", row_),
                 fmt::format("expected the header {}, found {}", fmt::join(required, ","), shown(header))}};
    }
}

bool CsvReader::readLine(std::string_view& line) {
    while (!rest_.empty()) {
        ++row_;
        const auto end = rest_.find('\n');
        line = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        if (!line.empty() && line.back() == '\r')
            line.remove_suffix(1);
        if (!trimmed(line).empty())
            return true;
    }
    return false;
}

bool CsvReader::next() {
    std::string_view line;
    if (!readLine(line))
        return false;
    fields_ = split(line);
    if (fields_.size() != columns_.size())
        throw FileErrorException{{file_, fmt::format("row {}", row_),
                                  fmt::format("expected {} columns, found {}", columns_.size(), fields_.size())}};
    return true;
}

std::optional<std::size_t> CsvReader::find(std::string_view column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    if (found == columns_.end())
        return std::nullopt;
    return static_cast<std::size_t>(found - columns_.begin());
}

void CsvReader::fail(std::string_view column, const std::string& problem) const {
    throw FileErrorException{{file_, fmt::format("row {}, column {}", row_, column), problem}};
}

std::string_view CsvReader::text(std::string_view column) const {
    return fields_.at(find(column).value());
}

double CsvReader::number(std::string_view column) const {
    const std::string_view field = text(column);
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error == std::errc::result_out_of_range)
        fail(column, fmt::format("expected a number in the range of a double, found '{}'", shown(field)));
    if (error != std::errc() || end != field.data() + field.size())
        fail(column, fmt::format("expected a number, found '{}'", shown(field)));
    if (!std::isfinite(value))
        fail(column, fmt::format("expected a finite number, found '{}'", shown(field)));
    return value;
}

long long CsvReader::integer(std::string_view column, long long low, long long high) const {
    const std::string_view field = text(column);
    long long value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || value < low || value > high)
        fail(column, fmt::format("expected an integer from {} to {}, found '{}'", low, high, shown(field)));
    return value;
}

std::optional<double> CsvReader::optionalNumber(std::string_view column) const {
    const auto index = find(column);
    if (!index || fields_[*index].empty())
        return std::nullopt;
    return number(column);
}

}  // namespace skincal
