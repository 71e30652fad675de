#include <fmt/format.h>

#include <map>

#include "app/command_application.h"
#include "app/command_line.h"
#include "app/skin_address.h"
#include "app/text_layout.h"
#include "core/device/protocol_skin.h"
#include "core/formats/file_error.h"
#include "core/skin/patches.h"

namespace skincal {
namespace {

struct ExploreArguments {
    SkinArguments skin;
    bool json = false;
};

nlohmann::ordered_json toJson(const Skin& skin, const SkinNetwork& network) {
    nlohmann::ordered_json json;
    json["modules"] = nlohmann::ordered_json::array();
    for (const SkinModule& module : skin.modules)
        json["modules"].push_back(
            {{"id", module.id.value}, {"type", skin.templates[module.type].name}, {"unique_id", module.uniqueId}});
    json["links"] = nlohmann::ordered_json::array();
    for (const Link& link : skin.links)
        json["links"].push_back(
            {{"a", link.a.value}, {"a_port", link.a_port}, {"b", link.b.value}, {"b_port", link.b_port}});
    json["host_links"] = nlohmann::ordered_json::array();
    for (const HostLink& host : skin.hostLinks)
        json["host_links"].push_back({{"module", host.module.value}, {"port", host.port}});
    json["silent_cells"] = network.missing;
    return json;
}

void print(const Skin& skin, const SkinNetwork& network) {
    std::map<std::string, int> ofType;
    for (const SkinModule& module : skin.modules)
        ++ofType[skin.templates[module.type].name];
    fmt::print("{} modules", skin.modules.size());
    for (const auto& [type, count] : ofType)
        fmt::print(", {} of type \"{}\"", count, printable(type));
    fmt::print("; {} links\n", skin.links.size());
    for (const HostLink& host : skin.hostLinks)
        fmt::print("the computer hangs on port {} of module {}\n", host.port, host.module.value);
    fmt::print("\nmodule  unique id                 neighbours (port: module.port)\n");
    std::map<ModuleId, std::map<int, std::pair<ModuleId, int>>> neighbours;
    for (const Link& link : skin.links) {
        neighbours[link.a][link.a_port] = {link.b, link.b_port};
        neighbours[link.b][link.b_port] = {link.a, link.a_port};
    }
    for (const SkinModule& module : skin.modules) {
        std::string text;
        for (const auto& [port, there] : neighbours[module.id])
            text += fmt::format("  {}: {}.{}", port, there.first.value, there.second);
        fmt::print("{:>6}  {}{}\n", module.id.value, module.uniqueId, text);
    }
    if (!network.missing.empty())
        fmt::print("\n{} cells take part in the network, but did not describe themselves: numbers {}\n",
                   network.missing.size(), fmt::join(network.missing, ", "));
}

int runExplore(const ExploreArguments& arguments) {
    const auto address = skinAddress(arguments.skin);
    if (!address)
        return badInput(address.error());
    const CommandApplication<QCoreApplication> application;
    ProtocolSkin device(address->line, address->templates);
    QObject::connect(&device, &SkinDevice::opened, &device, [&] { device.explore(); });
    QObject::connect(&device, &SkinDevice::failed, &application,
                     [](const QString& why) { QCoreApplication::exit(badInput(why.toStdString())); });
    QObject::connect(&device, &SkinDevice::explored, &application, [&](const Skin& skin) {
        if (arguments.json)
            printJson(toJson(skin, device.network()));
        else
            print(skin, device.network());
        QCoreApplication::exit(device.network().missing.empty() ? kDone : kDataDoNotSuffice);
    });
    device.open();
    return QCoreApplication::exec();
}

}  // namespace

void addExploreCommand(CommandLine& line) {
    auto arguments = std::make_shared<ExploreArguments>();
    CLI::App* command = line.app.add_subcommand("explore", "Ask a skin for its modules and how they are linked");
    command
        ->add_option("device,--device", arguments->skin.device,
                     "A serial port (/dev/ttyUSB0, or with its speed /dev/ttyUSB0@921600), tcp://host:port, or "
                     "exec:COMMAND, a program that speaks the protocol on its input and output, quoted as in a shell")
        ->required();
    command->add_option(
        "--template", arguments->skin.templates,
        "Module templates of your own (JSON), where cells are none of those that come with the program");
    command->add_flag("--json", arguments->json, "Print JSON");
    command->footer(
        "Exit codes: 0 done; 1 some cells did not answer (they are listed); 2 the skin can't be reached: why, and what "
        "to do about it, is printed.");
    command->callback([&line, arguments] { line.run = [arguments] { return runExplore(*arguments); }; });
}

}  // namespace skincal
