#include <fmt/format.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "app/command_line.h"
#include "app/qt_messages.h"
#include "app/window.h"
#include "core/formats/file_error.h"

namespace skincal {

int badInput(const std::string& message) {
    fmt::print(stderr, "skincal: {}\n", message);
    return kBadInput;
}

int dataDoNotSuffice(const std::string& message) {
    fmt::print(stderr, "skincal: {}\n", message);
    return kDataDoNotSuffice;
}

void printJson(const nlohmann::ordered_json& json) {
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void addSeedOption(CLI::App& command, std::uint64_t& seed, const std::string& description, const std::string& option) {
    const auto isSeed = [](const std::string& text) -> std::string {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error == std::errc() && end == text.data() + text.size())
            return {};
        return "expected a whole number from 0 to 18446744073709551615, found '" + printable(text) + "'";
    };
    command.add_option(option, seed, description)
        ->check(CLI::Validator(isSeed, "UINT64", "seed"))
        ->capture_default_str();
}

namespace {

int runProgram(int argc, char** argv) {
    CommandLine line;
    line.app.name("skincal");
    line.app.set_version_flag("--version", "skincal " SKINCAL_VERSION);
    line.app.require_subcommand(0, 1);
    WindowOptions window;
    line.app.add_flag("--demo", window.demo,
                      "Open the window on a simulated arm with skin and a webcam, connected already");
    line.app.add_flag("--light", window.light, "Light colours");
    const auto isRecording = [&line](const std::string& path) -> std::string {
        std::error_code none;
        if (std::filesystem::is_directory(path, none))
            return {};
        std::string commands;
        for (const CLI::App* command : line.app.get_subcommands({}))
            commands += (commands.empty() ? "" : ", ") + command->get_name();
        return "'" + printable(path) + "' is neither a command nor the directory of a recording; commands are " +
               commands;
    };
    line.app
        .add_option("recording,--open", window.recording, "Open the window with this recording (a *.skinrec directory)")
        ->option_text("RECORDING")
        ->check(CLI::Validator(isRecording, "", "recording"));
    line.run = [&] { return runWindow(argc, argv, window); };
    const std::string exitCodes =
        "Exit codes: 0 done; 1 the data do not suffice (what is missing is printed), or the result is not to be "
        "trusted;\n"
        "2 bad input or usage.";
    line.app.footer(exitCodes);  // of every command that has none of its own
    addDemoCommand(line);
    addCalibrateCommand(line);
    addAdviseCommand(line);
    addSimulateCommand(line);
    addCompareCommand(line);
    addRenderCommand(line);
    addExportCommand(line);
    addReproducePaperCommand(line);
    addAccuracyStudyCommand(line);
    addScanStudyCommand(line);
    addExploreCommand(line);
    addRunCommand(line);
    addVirtualSkinCommand(line);
    line.app.footer(
        "Start here:\n"
        "  skincal demo                                    simulate a skin, calibrate it, look at the result\n"
        "  skincal calibrate arm.skinrec -o arm.body.json  your own recording\n"
        "  skincal export arm.body.json --format urdf -o arm.urdf\n\n" +
        exitCodes + "\nEvery command explains itself: skincal COMMAND --help.");
    // Commands that take orders from standard input go on in the background of a shell, where they have none.
    std::signal(SIGTTIN, SIG_IGN);
    try {
        line.app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return line.app.exit(error) == 0 ? kDone : kBadInput;
    }
    return line.run();
}

/// Standard output is buffered: that a disk is full shows when it is flushed, or before where much is printed.
bool standardOutputFailed() {
    return std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
}

}  // namespace
}  // namespace skincal

int main(int argc, char** argv) {
    using namespace skincal;
    hideWhatQtSaysOfSound();
    int code = kBadInput;
    try {
        code = runProgram(argc, argv);
    } catch (const std::exception& error) {
        // Nothing that a file holds leads here; if it does, it is a fault of ours and worth a report.
        if (std::ferror(stdout) == 0)
            return badInput(fmt::format("internal error: {}", error.what()));
    }
    if (standardOutputFailed())
        return badInput("can't write to standard output");
    return code;
}
