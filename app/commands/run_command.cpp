#include <fmt/format.h>

#include <QFileInfo>
#include <QGuiApplication>

#include "app/calibrate_to_file.h"
#include "app/command_application.h"
#include "app/command_line.h"
#include "app/guided_run.h"
#include "app/outcome.h"
#include "app/skin_address.h"
#include "core/camera/media_source.h"
#include "core/camera/webcam_source.h"
#include "core/formats/camera_file.h"
#include "core/formats/recording.h"
#include "core/session/session_storage.h"
#include "ui/presenters/skin_offer.h"

namespace skincal {
namespace {

struct RunArguments {
    SkinArguments skin;
    std::string camera;
    std::string intrinsics;
    std::filesystem::path output;
    std::filesystem::path body;
    GuidedRunOptions options;
    int patience_s = 120;
    std::string onPose;
    std::string onView;
    bool force = false;
    bool resume = false;
    bool json = false;
};

std::string othersThan(const std::string& wanted, const CameraList& list) {
    std::string text;
    for (const ListedCamera& camera : list.cameras())
        text += fmt::format("\n  \"{}\"{}", camera.description, camera.node.empty() ? "" : " at " + camera.node);
    return fmt::format("there is no camera \"{}\"{}", wanted,
                       text.empty() ? ", and no webcam is plugged in" : "; these are:" + text);
}

/// A webcam by its name or node, else a video or stream.
tl::expected<Offer<FrameSource>, std::string> cameraAt(const std::string& text,
                                                       const std::shared_ptr<CameraList>& list) {
    for (const ListedCamera& camera : list->cameras())
        if (camera.description == text || camera.node == text)
            return Offer<FrameSource>{QString::fromStdString(text), {}, [list, camera] {
                                          return std::make_unique<WebcamSource>(list, camera);
                                      }};
    const auto url = videoUrl(QString::fromStdString(text));
    const bool isThere = url && (!url->isLocalFile() || QFileInfo::exists(url->toLocalFile()));
    if (!isThere)
        return tl::unexpected(othersThan(text, *list));
    return Offer<FrameSource>{
        QString::fromStdString(text), {}, [url = *url] { return std::make_unique<MediaSource>(url); }};
}

/// Waits so long for the first camera to be listed: asking all of them takes its time.
void waitForCameras(const CameraList& list) {
    QTimer patience;
    patience.setSingleShot(true);
    patience.start(3000);
    while (list.cameras().empty() && patience.isActive())
        QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
}

int calibrateRecording(const RunArguments& arguments) {
    const auto recording = readRecording(arguments.output);
    if (!recording)
        return badInput(recording.error().message());
    return calibrateToFile(arguments.output, *recording, {}, arguments.body, arguments.json,
                           {{"recording", arguments.output.string()}});
}

int runGuided(RunArguments arguments) {
    const auto address = skinAddress(arguments.skin);
    if (!address)
        return badInput(address.error());
    const bool isBegun = std::filesystem::exists(arguments.output / "recording.json");
    if (isBegun && !arguments.force && !arguments.resume)
        return badInput(arguments.output.string() +
                        " holds a recording already: --resume goes on with it, --force replaces it");
    if (arguments.body.empty()) {
        arguments.body = arguments.output;
        arguments.body.replace_extension(".body.json");
    }
    if (!arguments.force && !arguments.resume) {
        if (const auto complaint = complaintAboutExisting(arguments.body))
            return badInput(*complaint);
    }
    if (arguments.options.views > 0 && arguments.camera.empty())
        return badInput(
            "--camera is needed for views: a webcam's name or node, a video file or a stream; --views 0 takes none");
    const auto lens = readCameraModel(arguments.intrinsics);
    if (!lens)
        return badInput(lens.error().message());

    prepareMultimedia();
    if (qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM"))
        qputenv("QT_QPA_PLATFORM", "offscreen");
    const CommandApplication<QGuiApplication> application;
    Workbench workbench;
    if (isBegun && arguments.resume) {
        auto begun = readSession(arguments.output);
        if (!begun)
            return badInput(begun.error());
        workbench.session().load(*std::move(begun));
    }
    workbench.moduleTypes = address->templates;
    workbench.skinOffers.push_back(offerOfAddress(address->line, address->templates));
    if (arguments.options.views > 0) {
        const auto list = std::make_shared<CameraList>();
        waitForCameras(*list);
        auto camera = cameraAt(arguments.camera, list);
        if (!camera)
            return badInput(camera.error());
        workbench.cameraOffers.push_back(std::move(*camera));
    }
    workbench.session().decide({}, [&](Decisions& decisions) {
        decisions.camera = *lens;
        decisions.cameraOrigin.kind = CameraOrigin::Kind::File;
        decisions.cameraOrigin.file = std::filesystem::path(arguments.intrinsics).filename().string();
    });
    arguments.options.directory = QString::fromStdString(arguments.output.string());
    arguments.options.absence = std::chrono::seconds(arguments.patience_s);
    arguments.options.onPose = QString::fromStdString(arguments.onPose);
    arguments.options.onView = QString::fromStdString(arguments.onView);
    std::optional<QString> why;
    {
        GuidedRun run(workbench, arguments.options);
        QObject::connect(&run, &GuidedRun::finished, &application, [&](const QString& reason) {
            why = reason;
            QCoreApplication::quit();
        });
        run.begin();
        QCoreApplication::exec();
    }
    if (why && why->isEmpty()) {
        if (arguments.options.views == 0)
            fmt::print(stderr, "All poses are measured. Views place the patches: --views, --camera and --resume\n");
        return calibrateRecording(arguments);
    }
    const int code = why ? badInput(why->toStdString()) : dataDoNotSuffice("interrupted");
    if (!workbench.session().measured().gravity.empty())
        fmt::print(stderr, "What was measured is in {}, and --resume goes on with it\n", arguments.output.string());
    return code;
}

}  // namespace

void addRunCommand(CommandLine& line) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* command = line.app.add_subcommand(
        "run", "Calibrate a skin from start to end without a window: connect, poses, views, body model");
    command->add_option("--device", arguments->skin.device, "The skin's address, see \"skincal explore --help\"")
        ->required();
    command->add_option("--camera", arguments->camera,
                        "Name or node (/dev/video0) of a webcam, a video file or the address of a stream");
    command
        ->add_option("--intrinsics", arguments->intrinsics,
                     "The camera's lens: ROS camera_info, OpenCV or Kalibr, YAML or XML; every recording has one")
        ->required();
    command->add_option("-o,--output", arguments->output, "The recording, a directory *.skinrec")->required();
    command->add_option("--body", arguments->body, "The body model [the output with .body.json]");
    command->add_option("--template", arguments->skin.templates, "Module templates of your own (JSON)");
    command->add_option("--poses", arguments->options.poses, "How many gravity poses")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--views", arguments->options.views, "How many views; 0: none, and no camera")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    command
        ->add_option("--code", arguments->options.code,
                     "How a scan tells modules apart: by words that all blink at once, or one at a time, which takes "
                     "two pictures per module")
        ->transform(CLI::CheckedTransformer(std::map<std::string, ScanCode>{{"words", ScanCode::Words},
                                                                            {"one-at-a-time", ScanCode::OneAtATime}})
                        .description(""))
        ->type_name("words|one-at-a-time")
        ->default_str("words");
    command->add_option("--on-pose", arguments->onPose,
                        "Shell command that turns the body, run before each pose but the first");
    command->add_option("--on-view", arguments->onView,
                        "Shell command that moves the camera, run before each view but the first");
    command
        ->add_option("--patience", arguments->patience_s,
                     "How many seconds a skin or camera that is lost in the midst is waited for")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    CLI::Option* force = command->add_flag("--force", arguments->force, "Replace what is there");
    command
        ->add_flag("--resume", arguments->resume,
                   "Go on with the recording where it was broken off, if it is of the same skin")
        ->excludes(force);
    command->add_flag("--json", arguments->json, "Print the result as JSON");
    command->footer(
        "Without commands it says what to do, and waits: for a pose until the body rests, for a view until Enter is\n"
        "pressed. Commands get SKINCAL_POSE or SKINCAL_VIEW (from 0), and SKINCAL_UP, the direction of module\n"
        "SKINCAL_MODULE that should point up. Everything is written to the recording as soon as it is measured.\n"
        "A skin or camera that is unplugged in the midst is waited for, and what it was needed for is done anew.\n"
        "Exit codes: 0 done; 1 the data do not suffice, or interrupted; 2 bad input, or skin or camera failed.");
    command->callback([&line, arguments] { line.run = [arguments] { return runGuided(*arguments); }; });
}

}  // namespace skincal
