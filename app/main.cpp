#include <fmt/format.h>

#include <exception>

#include "app/command_line.h"

namespace skincal {

int badInput(const std::string& message) {
    fmt::print(stderr, "skincal: {}\n", message);
    return kBadInput;
}

}  // namespace skincal

int main(int argc, char** argv) {
    using namespace skincal;
    try {
        CommandLine line;
        line.app.name("skincal");
        line.app.set_version_flag("--version", "skincal " SKINCAL_VERSION);
        line.app.require_subcommand(1);
        line.app.footer(
            "Start here:\n"
            "  skincal demo                                   simulate a skin, calibrate it, look at the result\n"
            "  skincal calibrate arm.skinrec -o arm.body.json  your own recording\n"
            "  skincal export arm.body.json --format urdf -o arm.urdf\n\n"
            "Exit codes: 0 done; 1 the data do not suffice (what is missing is printed); 2 bad input or usage.\n"
            "Every command explains itself: skincal COMMAND --help.");
        addDemoCommand(line);
        addCalibrateCommand(line);
        addSimulateCommand(line);
        addCompareCommand(line);
        addRenderCommand(line);
        addExportCommand(line);
        addReproducePaperCommand(line);
        try {
            line.app.parse(argc, argv);
        } catch (const CLI::ParseError& error) {
            return line.app.exit(error) == 0 ? kDone : kBadInput;
        }
        return line.run();
    } catch (const std::exception& error) {
        // Nothing that a file holds leads here; if it does, it is a fault of ours and worth a report.
        return badInput(fmt::format("internal error: {}", error.what()));
    }
}
