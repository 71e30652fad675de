#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace skincal {

struct WindowOptions {
    std::string scenario = "demo";                   ///< what the rig is
    std::optional<std::filesystem::path> recording;  ///< to open at once
    bool demo = false;                               ///< begins at the simulated rig, connected
    bool light = false;                              ///< light colours, whatever the desktop has
};

/// Opens the window and runs until it is closed. Needs a display.
int runWindow(int argc, char** argv, const WindowOptions& options);

}  // namespace skincal
