#include "core/device/protocol_skin.h"

#include <QPointer>
#include <algorithm>

namespace skincal {
namespace {

template <class Function>
void post(QObject* receiver, Function function) {
    QMetaObject::invokeMethod(receiver, std::move(function), Qt::QueuedConnection);
}

}  // namespace

ProtocolSkin::ProtocolSkin(LineAddress address, std::vector<ModuleTemplate> templates, QObject* parent)
    : SkinDevice(parent), address_(address), templates_(std::move(templates)), worker_(new SkinWorker(address)) {
    worker_->moveToThread(&thread_);
    connect(&thread_, &QThread::finished, worker_, &QObject::deleteLater);
    connect(worker_, &SkinWorker::opened, this, [this](const QString&, quint64 opening) {
        if (state_ != State::Opening || opening != opening_)
            return;
        state_ = State::Open;
        emit opened();
    });
    connect(worker_, &SkinWorker::failed, this, [this](const QString& why, quint64 opening) {
        if (state_ == State::Closed || opening != opening_)
            return;
        const bool wasOpen = std::exchange(state_, State::Closed) == State::Open;
        forgetNumbers();
        const QPointer<ProtocolSkin> self(this);
        emit failed(why);
        if (self && wasOpen)
            emit closed();
    });
    connect(worker_, &SkinWorker::cellFound, this, [this](const NetworkCell& cell) {
        if (state_ == State::Open && asked_)
            emit moduleFound(modules_.idOf(cell));
    });
    connect(worker_, &SkinWorker::explored, this, &ProtocolSkin::adopt);
    connect(worker_, &SkinWorker::numbersLost, this, &ProtocolSkin::forgetNumbers);
    connect(worker_, &SkinWorker::shown, this, [this](quint64 token) {
        if (state_ == State::Open)
            emit lightShown(token);
    });
    connect(worker_, &SkinWorker::notShown, this, [this](const std::vector<CellNumber>& dark) {
        std::vector<ModuleId> modules;
        for (const CellNumber cell : dark)
            if (const auto module = moduleOf(cell))
                modules.push_back(*module);
        if (state_ == State::Open)
            emit lightMissed(modules);
    });
    connect(worker_, &SkinWorker::cameBack, this, [this] {
        if (state_ == State::Closed)
            emit cameBack();
    });
    connect(worker_, &SkinWorker::accelerationCame, this, &ProtocolSkin::emitAcceleration);
    connect(worker_, &SkinWorker::touchCame, this, &ProtocolSkin::emitTouch);
    thread_.setObjectName(QStringLiteral("skin"));
    thread_.start();
}

ProtocolSkin::~ProtocolSkin() {
    worker_->disconnect(this);
    thread_.quit();
    thread_.wait();
}

void ProtocolSkin::open() {
    if (state_ != State::Closed)
        return;
    state_ = State::Opening;
    post(worker_, [worker = worker_, opening = ++opening_] { worker->open(opening); });
}

void ProtocolSkin::close() {
    if (state_ == State::Closed)
        return;
    const bool wasOpen = std::exchange(state_, State::Closed) == State::Open;
    forgetNumbers();
    post(worker_, [worker = worker_] { worker->close(); });
    if (wasOpen)
        post(this, [this] { emit closed(); });
}

void ProtocolSkin::explore() {
    if (state_ != State::Open) {
        post(this, [this] { emit failed(tr("the skin is not open")); });
        return;
    }
    asked_ = true;
    post(worker_, [worker = worker_] { worker->explore(); });
}

void ProtocolSkin::forgetNumbers() {
    moduleOf_.clear();
    cellOf_.clear();
}

void ProtocolSkin::adopt(const SkinNetwork& network, quint64 exploration) {
    if (state_ != State::Open)
        return;
    forgetNumbers();
    exploration_ = exploration;
    const auto skin = skinOf(network, templates_, modules_);
    if (!skin) {
        const QString type = QString::fromStdString(skin.error());
        emit failed(
            tr("a cell says that it is of the type \"%1\": no module template has that name; \"skincal explore\" and "
               "\"skincal run\" take its file with --template FILE")
                .arg(type));
        return;
    }
    network_ = network;
    std::set<std::string> found;
    moduleOf_.resize(network.cells.size() + network.missing.size() + 1);
    for (const NetworkCell& cell : network.cells) {
        const ModuleId module = modules_.idOf(cell);
        moduleOf_[cell.number] = module;
        cellOf_.emplace(module, cell.number);
        found.insert(cell.uniqueId);
    }
    if (!prepared_.empty())
        prepare(prepared_);
    const bool changed = found != std::exchange(known_, found);
    tellLight();
    if (std::exchange(asked_, false) || changed)
        emit explored(*skin);
}

std::optional<ModuleId> ProtocolSkin::moduleOf(CellNumber cell) const {
    return cell < moduleOf_.size() ? moduleOf_[cell] : std::nullopt;
}

std::vector<LitCell> ProtocolSkin::cellsOf(const std::vector<LitModule>& lit) const {
    std::vector<LitCell> cells;
    for (const LitModule& one : lit) {
        const auto cell = cellOf_.find(one.module);
        if (cell == cellOf_.end())
            continue;  // it does not answer: nothing that is lit will be taken for it
        const std::array<int, 3> c = one.colour.value_or(std::array{1, 1, 1});
        if (c == std::array{0, 0, 0})
            continue;  // as dark as any that is not lit
        cells.push_back({cell->second, static_cast<std::uint8_t>((c[0] ? 1 : 0) | (c[1] ? 2 : 0) | (c[2] ? 4 : 0))});
    }
    std::sort(cells.begin(), cells.end(), [](const LitCell& a, const LitCell& b) { return a.cell < b.cell; });
    return cells;
}

void ProtocolSkin::prepare(const std::vector<std::vector<LitModule>>& sets) {
    prepared_ = sets;
    if (sets.size() > 64)
        return;  // masks will do
    std::vector<std::vector<LitCell>> cells;
    for (const std::vector<LitModule>& set : sets)
        cells.push_back(cellsOf(set));
    post(worker_, [worker = worker_, cells = std::move(cells)] { worker->prepare(cells); });
}

std::vector<SilentModule> ProtocolSkin::silent() const {
    std::vector<SilentModule> silent;
    for (const CellNumber number : network_.missing) {
        SilentModule& one = silent.emplace_back(SilentModule{number, {}});
        for (const NetworkCell& cell : network_.cells) {
            const auto module = moduleOf(cell.number);
            const bool hears = std::any_of(cell.heard.begin(), cell.heard.end(),
                                           [&](const NetworkCell::Heard& heard) { return heard.cell == number; });
            if (hears && module)
                one.beside.push_back(*module);
        }
    }
    return silent;
}

std::uint64_t ProtocolSkin::light(const std::vector<LitModule>& lit) {
    lit_ = lit;
    ++token_;
    tellLight();
    return token_;
}

std::uint64_t ProtocolSkin::lightAt(const std::vector<LitModule>& lit, std::chrono::microseconds when) {
    lit_ = lit;
    ++token_;
    tellLight(when);
    return token_;
}

/// While cells have no numbers it waits for adopt().
void ProtocolSkin::tellLight(std::optional<std::chrono::microseconds> when) {
    if (state_ == State::Open && !cellOf_.empty())
        post(worker_, [worker = worker_, cells = cellsOf(lit_), token = token_, exploration = exploration_, when] {
            worker->light(cells, token, exploration, when);
        });
}

void ProtocolSkin::streamAcceleration(bool on) {
    post(worker_, [worker = worker_, on] { worker->streamRest(on); });
}

void ProtocolSkin::streamTactile(bool on) {
    post(worker_, [worker = worker_, on] { worker->streamTouch(on); });
}

void ProtocolSkin::emitAcceleration(const std::vector<RestReading>& readings, qint64 time_us) {
    AccelerationSample sample;
    sample.time = std::chrono::microseconds(time_us);
    for (const RestReading& reading : readings)
        if (const auto module = moduleOf(reading.cell))
            sample.readings.push_back({*module, reading.mean});
    if (state_ == State::Open && !sample.readings.empty())
        emit accelerationArrived(sample);
}

void ProtocolSkin::emitTouch(const std::vector<CellTouch>& touches, qint64 time_us) {
    TactileSample sample;
    sample.time = std::chrono::microseconds(time_us);
    for (const CellTouch& touch : touches)
        if (const auto module = moduleOf(touch.cell))
            sample.readings.push_back({*module, touch.proximity, touch.force, touch.temperature, touch.acceleration});
    if (state_ == State::Open && !sample.readings.empty())
        emit tactileArrived(sample);
}

}  // namespace skincal
