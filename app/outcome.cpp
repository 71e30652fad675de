#include "app/outcome.h"

#include <fmt/format.h>

#include "app/command_line.h"
#include "core/formats/files.h"

namespace skincal {

int exitCodeOf(const BodyModel& body) {
    const BodyQuality& q = body.quality;
    const bool enough = q.modulesPlaced > 0 && q.modulesPlaced == q.modulesTotal && q.trust != Trust::NotToBeTrusted;
    return enough ? kDone : kDataDoNotSuffice;
}

int reportFailure(const CalibrateError& error) {
    if (error.cancelled)
        return badInput("interrupted, nothing was written");
    if (error.badInput)
        return badInput(error.message);
    return dataDoNotSuffice("the data do not suffice: " + error.message);
}

std::optional<std::string> complaintAboutOutput(const std::filesystem::path& output,
                                                const std::vector<std::filesystem::path>& inputs) {
    if (const auto target = resolveOutput(output); !target)
        return target.error().message();
    for (const std::filesystem::path& input : inputs) {
        if (sameFile(output, input))
            return FileError{output, "", "expected another file for the output, this one is read"}.message();
    }
    return std::nullopt;
}

std::optional<std::string> complaintAboutExisting(const std::filesystem::path& output) {
    std::error_code error;
    if (!std::filesystem::exists(output, error))
        return std::nullopt;
    return FileError{output, "", "there is such a file already: give another with -o, or --force to replace it"}
        .message();
}

std::vector<std::filesystem::path> pathsOf(const std::filesystem::path& directory, const Recording& recording) {
    std::vector<std::filesystem::path> paths;
    for (const std::string& file : filesOf(recording))
        paths.push_back(directory / file);
    return paths;
}

}  // namespace skincal
