#pragma once

#include <filesystem>
#include <string>

namespace skincal {

/// For a line of a terminal: control characters, which a hostile file may hold, become spaces.
[[nodiscard]] std::string printable(std::string text);

/// A file that can't be read, written or believed.
struct FileError {
    std::filesystem::path file;
    std::string place;    ///< key, row or column: "links[3].a_port", "row 12, column ax"; empty for the whole file
    std::string problem;  ///< what was expected and what was found: "expected a port 0 to 3 of 'hex', found 7"

    /// "FILE: PLACE: PROBLEM" on one line that a terminal can show: control characters, which a hostile file may hold,
    /// become spaces, and an endless name is cut short.
    [[nodiscard]] std::string message() const;
};

}  // namespace skincal
