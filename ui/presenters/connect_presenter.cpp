#include "ui/presenters/connect_presenter.h"

#include <chrono>
#include <map>

#include "ui/texts/sentences.h"

namespace skincal {
namespace {

constexpr int kBlinkSteps = 8;  // on and off, four times
constexpr std::chrono::milliseconds kBlink{150};

}  // namespace

std::vector<WiringFault> wiringFaults(const Skin& skin) {
    std::vector<WiringFault> faults;
    std::map<std::pair<ModuleId, int>, std::set<LinkKey>> ofPort;
    std::set<ModuleId> linked;
    for (const Link& link : skin.links) {
        if (link.a == link.b) {
            faults.push_back({WiringFault::Kind::SelfLink, {link.a}});
            continue;
        }
        const LinkKey key = LinkKey::of(link);
        ofPort[{link.a, link.a_port}].insert(key);
        ofPort[{link.b, link.b_port}].insert(key);
        linked.insert(link.a);
        linked.insert(link.b);
    }
    for (const auto& [port, links] : ofPort) {
        if (links.size() < 2)
            continue;
        std::set<ModuleId> modules{port.first};
        for (const LinkKey& link : links)
            modules.insert({link.a, link.b});
        faults.push_back({WiringFault::Kind::DoublyWired, {modules.begin(), modules.end()}});
    }
    for (const SkinModule& module : skin.modules) {
        if (!linked.contains(module.id) && skin.modules.size() > 1)
            faults.push_back({WiringFault::Kind::NoLink, {module.id}});
    }
    return faults;
}

QString sentenceOf(const Connection& connection, const QString& deviceSays) {
    using Fault = Connection::Fault;
    switch (connection.fault) {
        case Fault::None:
            return {};
        case Fault::Failed:
            return deviceSays.isEmpty() ? ConnectPresenter::tr("The skin failed") : capitalised(deviceSays);
        case Fault::Closed:
            return ConnectPresenter::tr("The skin was disconnected");
        case Fault::NoAnswer:
            return ConnectPresenter::tr("The skin does not answer: is it powered, and is this its port?");
        case Fault::NoModules:
            return ConnectPresenter::tr("The skin is open, but no module reports");
        default:
            return ConnectPresenter::tr("The network went silent after %n modules had reported", nullptr,
                                        static_cast<int>(connection.found));
    }
}

ConnectPresenter::ConnectPresenter(Workbench& workbench, QObject* parent)
    : QObject(parent), workbench_(workbench), links_(workbench) {
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, [this] { handle(connection::TimedOut{}); });
    blinkTimer_.setInterval(kBlink);
    connect(&blinkTimer_, &QTimer::timeout, this, &ConnectPresenter::blinkStep);
    connect(&workbench, &Workbench::skinChosen, this, &ConnectPresenter::attachDevice);
    if (workbench.skin() != nullptr)
        attachDevice();
}

void ConnectPresenter::chooseDevice(int offer) {
    if (offer == workbench_.chosenSkin())
        return;
    handle(connection::Disconnect{});
    workbench_.chooseSkin(static_cast<std::size_t>(offer));
}

void ConnectPresenter::connectSkin() {
    if (workbench_.skin() == nullptr && !workbench_.skinOffers.empty())
        workbench_.chooseSkin(0);
    if (workbench_.skin() != nullptr)
        handle(connection::Connect{});
}

void ConnectPresenter::disconnectSkin() {
    handle(connection::Disconnect{});
}

void ConnectPresenter::blink(ModuleId module) {
    if (!workbench_.isSkinReady() || workbench_.isScanning())
        return;
    emit workbench_.lightsClaimed();
    blinks_ = module;
    blinkSteps_ = kBlinkSteps;
    blinkStep();
    blinkTimer_.start();
}

void ConnectPresenter::blinkStep() {
    if (blinkSteps_ == 0 || !workbench_.isSkinReady() || workbench_.isScanning()) {
        blinkTimer_.stop();
        return;
    }
    const bool on = blinkSteps_-- % 2 == 0;
    workbench_.skin()->light(on ? std::vector<LitModule>{{blinks_, std::nullopt}} : std::vector<LitModule>{});
    emit blinking(blinks_, on);
}

void ConnectPresenter::attachDevice() {
    SkinDevice* device = workbench_.skin();
    state_ = {};
    found_.clear();
    gone_.clear();
    strangers_ = 0;
    dark_.clear();
    timer_.stop();
    connect(device, &SkinDevice::opened, this, [this] { handle(connection::Opened{}); });
    connect(device, &SkinDevice::closed, this, [this] { handle(connection::Closed{}); });
    connect(device, &SkinDevice::failed, this, [this](const QString& why) {
        deviceSays_ = why;
        handle(connection::Failed{});
    });
    connect(device, &SkinDevice::cameBack, this, [this] {
        if (state_.phase == Connection::Phase::Lost)
            connectSkin();
    });
    const auto setDark = [this](const std::vector<ModuleId>& dark) {
        if (std::exchange(dark_, dark) != dark)
            emit stateChanged();
    };
    connect(device, &SkinDevice::lightMissed, this, setDark);
    connect(device, &SkinDevice::lightShown, this, [setDark] { setDark({}); });
    connect(device, &SkinDevice::moduleFound, this, [this](ModuleId module) {
        found_.push_back(module);
        handle(connection::ModuleFound{});
    });
    connect(device, &SkinDevice::explored, this, [this](const Skin& skin) {
        const bool isExpected = state_.phase == Connection::Phase::Exploring;
        if (isExpected)
            workbench_.session().adoptSkin(skin);
        compare(skin);
        handle(connection::Explored{});
    });
    emit stateChanged();
}

void ConnectPresenter::compare(const Skin& skin) {
    gone_.clear();
    strangers_ = 0;
    const auto now = skin.indexById();
    const auto known = workbench_.session().measured().skin.indexById();
    for (const auto& [module, index] : known) {
        if (!now.contains(module))
            gone_.push_back(module);
    }
    std::sort(gone_.begin(), gone_.end());
    for (const auto& [module, index] : now)
        strangers_ += known.contains(module) ? 0 : 1;
}

void ConnectPresenter::handle(const connection::Event& event) {
    const auto [state, effects] = step(state_, event);
    state_ = state;
    SkinDevice* device = workbench_.skin();
    for (const connection::Effect& effect : effects) {
        std::visit(
            Overloaded{[&](connection::OpenDevice) { device->open(); },
                       [&](connection::CloseDevice) { device->close(); },
                       [&](connection::Explore) {
                           found_.clear();
                           device->remember(workbench_.session().measured().skin);
                           device->explore();
                       },
                       [&](const StartTimer& timer) { timer_.start(timer.after); }, [&](StopTimer) { timer_.stop(); }},
            effect);
    }
    workbench_.setSkinReady(state_.phase == Connection::Phase::Connected);
    emit stateChanged();
}

}  // namespace skincal
