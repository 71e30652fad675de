#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "tests/unit/formats/temporary_directory.h"

namespace skincal::test {

struct Outcome {
    int code = -1;
    std::string output;  ///< standard output
    std::string error;   ///< standard error
};

/// @param environment  set for the program alone, "DISPLAY=:0".
inline Outcome run(const std::string& arguments, const std::string& environment = {}) {
    const TemporaryDirectory directory;
    const std::string errorFile = (directory / "stderr").string();
    Outcome outcome;
    const std::string command = "env " + environment + " " + SKINCAL_PROGRAM + " " + arguments + " 2>" + errorFile;
    FILE* pipe = ::popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        outcome.output.append(buffer.data(), n);
    const int status = ::pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.error = readText(errorFile);
    return outcome;
}

}  // namespace skincal::test
