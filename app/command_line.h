#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/geometry/run_context.h"

namespace skincal {

/// What the program's exit code says.
enum ExitCode {
    kDone = 0,
    kDataDoNotSuffice = 1,
    kBadInput = 2,
};

/// Each command adds itself to the program and sets `run` to what it does when it was the one asked for.
struct CommandLine {
    CLI::App app{"SkinCal finds out where every cell of a robot skin sits."};
    std::function<int()> run;
};

void addCalibrateCommand(CommandLine& line);
void addAdviseCommand(CommandLine& line);
void addCompareCommand(CommandLine& line);
void addExportCommand(CommandLine& line);
void addRenderCommand(CommandLine& line);
void addSimulateCommand(CommandLine& line);
void addReproducePaperCommand(CommandLine& line);
void addAccuracyStudyCommand(CommandLine& line);
void addScanStudyCommand(CommandLine& line);
void addDemoCommand(CommandLine& line);
void addExploreCommand(CommandLine& line);
void addRunCommand(CommandLine& line);
void addVirtualSkinCommand(CommandLine& line);

/// Prints "skincal: MESSAGE" to standard error and returns kBadInput.
int badInput(const std::string& message);

/// Prints "skincal: MESSAGE" to standard error and returns kDataDoNotSuffice.
int dataDoNotSuffice(const std::string& message);

/// Prints to standard output; bytes that are no UTF-8, as a path may hold, are replaced.
void printJson(const nlohmann::ordered_json& json);

/// --seed, or another name: a whole number from 0 to 2^64 - 1, and nothing that a conversion would bend into one.
void addSeedOption(CLI::App& command, std::uint64_t& seed, const std::string& description,
                   const std::string& option = "--seed");

/// True once the user pressed Ctrl-C.
bool interrupted();

/// Shows stage and share done on a terminal's last line, from the first second on; silent where standard error is no
/// terminal. Ends its line when destroyed.
class TerminalProgress {
  public:
    TerminalProgress();
    ~TerminalProgress();
    TerminalProgress(const TerminalProgress&) = delete;
    TerminalProgress& operator=(const TerminalProgress&) = delete;

    /// Reports here; cancelled by Ctrl-C.
    [[nodiscard]] RunContext context();

  private:
    struct Shown;
    std::unique_ptr<Shown> shown_;
};

}  // namespace skincal
