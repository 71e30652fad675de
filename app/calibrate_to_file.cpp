#include "app/calibrate_to_file.h"

#include <fmt/format.h>

#include "app/command_line.h"
#include "app/outcome.h"
#include "core/formats/body_json.h"
#include "core/formats/files.h"

namespace skincal {

int calibrateToFile(const std::filesystem::path& directory, const Recording& recording, const CalibrateOptions& options,
                    const std::filesystem::path& output, bool json, std::vector<TableRow> more) {
    tl::expected<BodyModel, CalibrateError> body;
    {
        TerminalProgress progress;
        body = calibrate(recording, framesOf(directory, recording), options, progress.context());
    }
    if (!body)
        return reportFailure(body.error());
    auto digests = digestRecording(directory, recording);
    if (!digests)
        return badInput(digests.error().message());
    body->generator.recording_sha256 = std::move(*digests);
    if (const auto written = writeBody(*body, output, recording.unknownOfTypes); !written)
        return badInput(written.error().message());
    if (json) {
        auto figures = qualityJson(*body);
        figures["output"] = output.string();
        printJson(figures);
    } else {
        more.emplace_back("body model", output.string());
        fmt::print("{}", qualityTable(*body, more));
    }
    return exitCodeOf(*body);
}

}  // namespace skincal
