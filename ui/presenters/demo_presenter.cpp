#include "ui/presenters/demo_presenter.h"

#include <QLocale>
#include <algorithm>

namespace skincal {

QString nameOf(Quantity quantity) {
    switch (quantity) {
        case Quantity::Proximity:
            return DemoPresenter::tr("Proximity");
        case Quantity::Force:
            return DemoPresenter::tr("Force");
        case Quantity::Temperature:
            return DemoPresenter::tr("Temperature");
        case Quantity::Acceleration:
            return DemoPresenter::tr("Acceleration");
    }
    return {};
}

QString unitOf(Quantity quantity) {
    switch (quantity) {
        case Quantity::Proximity:
            return {};
        case Quantity::Force:
            return DemoPresenter::tr("N");
        case Quantity::Temperature:
            return DemoPresenter::tr("°C");
        case Quantity::Acceleration:
            return DemoPresenter::tr("m/s²");
    }
    return {};
}

namespace {

QString withUnit(const QString& number, Quantity quantity) {
    const QString unit = unitOf(quantity);
    return unit.isEmpty() ? number : number + QChar(0x00a0) + unit;
}

}  // namespace

QString textOf(double value, Quantity quantity) {
    const int digits = quantity == Quantity::Temperature || quantity == Quantity::Acceleration ? 1 : 2;
    return withUnit(QLocale().toString(value, 'f', digits), quantity);
}

QString endOf(double value, Quantity quantity) {
    return withUnit(QLocale().toString(value, 'g', 3), quantity);
}

DemoPresenter::DemoPresenter(Workbench& workbench, QObject* parent) : QObject(parent), workbench_(workbench) {
    timer_.setInterval(kUpdate_ms);
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, [this] {
        if (isStale_)
            refresh();
    });
    const Session& session = workbench.session();
    connect(&session, &Session::skinChanged, this, &DemoPresenter::takeBody);
    connect(&session, &Session::solutionChanged, this, &DemoPresenter::takeBody);
    connect(&workbench, &Workbench::skinChosen, this, &DemoPresenter::attachDevice);
    connect(&workbench, &Workbench::skinReadyChanged, this, [this] { setActive(isActive_); });
    if (workbench.skin() != nullptr)
        attachDevice();
}

void DemoPresenter::attachDevice() {
    connect(workbench_.skin(), &SkinDevice::tactileArrived, this, &DemoPresenter::takeSample);
}

void DemoPresenter::setActive(bool active) {
    isActive_ = active;
    if (workbench_.skin() != nullptr)
        workbench_.skin()->streamTactile(isStreaming());
    if (active) {
        takeBody();
        timer_.start();
    } else {
        timer_.stop();
        release();
    }
    emit stateChanged();
}

void DemoPresenter::takeBody() {
    // The history is large: it is made when somebody looks.
    if (!isActive_)
        return;
    Session& session = workbench_.session();
    if (session.solution()) {
        body_ = std::shared_ptr<const BodyModel>(session.solution(), &session.solution()->body);
    } else {
        auto unplaced = std::make_shared<BodyModel>();
        for (const SkinModule& module : session.measured().skin.modules)
            unplaced->modules.emplace_back().id = module.id;
        body_ = std::move(unplaced);
    }
    std::vector<ModuleId> modules;
    for (const BodyModule& module : body_->modules)
        modules.push_back(module.id);
    if (!history_ || history_->modules() != modules) {
        history_.emplace(std::move(modules));
        picture_ = {};
        traced_ = {};
        ago_.reset();
    }
    isStale_ = true;
    emit stateChanged();
}

bool DemoPresenter::hasBody() const {
    return body_ && std::any_of(body_->modules.begin(), body_->modules.end(),
                                [](const BodyModule& module) { return module.T_body_module.has_value(); });
}

QString DemoPresenter::instruction() const {
    if (!workbench_.isSkinReady())
        return tr("Connect the skin to see what it feels.");
    if (!hasBody())
        return tr("The skin feels, but nothing is known yet of where: calibrate the body first.");
    if (!isLive())
        return tr("Paused: nothing is recorded until you go back to live.");
    return canTouch() ? tr("Drag over the body to touch its skin.") : tr("Touch the skin to see where it feels you.");
}

void DemoPresenter::takeSample(const TactileSample& sample) {
    if (!isActive_ || !history_ || !isLive())
        return;
    history_->add(sample);
    isStale_ = true;
}

void DemoPresenter::refresh() {
    isStale_ = false;
    if (!hasSamples())
        return;
    const Time newest = history_->timeOf(history_->size() - 1);
    const auto frame = history_->frameAt(newest - ago());
    drawPicture(picture_, history_->at(*frame), quantity_, *body_);
    if (isLive() && isFollowing_)
        followTouches();
    emit updated();
}

void DemoPresenter::followTouches() {
    const Time now = history_->timeOf(history_->size() - 1);
    const Traced before = traced_;
    for (const TouchContact& contact : picture_.contacts) {
        const auto place = std::find(traced_.begin(), traced_.end(), contact.module);
        if (place != traced_.end())
            touchedAt_.at(static_cast<std::size_t>(place - traced_.begin())) = now;
    }
    for (const TouchContact& contact : picture_.contacts) {
        if (std::find(traced_.begin(), traced_.end(), contact.module) != traced_.end())
            continue;
        std::size_t oldest = 0;
        for (std::size_t i = 1; i < kTraces && traced_.at(oldest); ++i) {
            if (!traced_.at(i) || touchedAt_.at(i) < touchedAt_.at(oldest))
                oldest = i;
        }
        if (traced_.at(oldest) && touchedAt_.at(oldest) == now)
            break;  // all of them are being touched
        traced_.at(oldest) = contact.module;
        touchedAt_.at(oldest) = now;
    }
    if (traced_ != before)
        emit stateChanged();
}

void DemoPresenter::setQuantity(Quantity quantity) {
    quantity_ = quantity;
    isStale_ = true;
    emit stateChanged();
}

DemoPresenter::Time DemoPresenter::span() const {
    return hasSamples() ? history_->timeOf(history_->size() - 1) - history_->timeOf(0) : Time::zero();
}

void DemoPresenter::setLive(bool live) {
    if (live == isLive())
        return;
    ago_ = live ? std::nullopt : std::optional(Time::zero());
    isStale_ = true;
    emit stateChanged();
}

void DemoPresenter::showAgo(Time ago) {
    const Time possible = std::clamp(ago, Time::zero(), span());
    if (ago_ == possible)
        return;
    ago_ = possible;
    isStale_ = true;
    emit stateChanged();
}

void DemoPresenter::setFollowing(bool following) {
    isFollowing_ = following;
    isStale_ = true;
    emit stateChanged();
}

void DemoPresenter::toggleTraced(ModuleId module) {
    isFollowing_ = false;
    const auto place = std::find(traced_.begin(), traced_.end(), module);
    if (place != traced_.end()) {
        place->reset();
    } else {
        const auto free = std::find(traced_.begin(), traced_.end(), std::nullopt);
        // The one that was chosen first makes room.
        const auto oldest = std::min_element(touchedAt_.begin(), touchedAt_.end()) - touchedAt_.begin();
        const std::size_t here = static_cast<std::size_t>(free != traced_.end() ? free - traced_.begin() : oldest);
        traced_.at(here) = module;
        touchedAt_.at(here) = *std::max_element(touchedAt_.begin(), touchedAt_.end()) + Time{1};
    }
    isStale_ = true;
    emit stateChanged();
}

std::vector<std::pair<std::size_t, Trace>> DemoPresenter::traces(std::size_t whiles) const {
    std::vector<std::pair<std::size_t, Trace>> traces;
    for (std::size_t i = 0; i < kTraces; ++i) {
        if (!traced_.at(i))
            continue;
        Trace trace{*traced_.at(i), {}};
        if (hasSamples()) {
            drawTrace(trace, *history_, quantity_, whiles);
            const Time newest = history_->timeOf(history_->size() - 1);
            const FeltModule felt = history_->at(*history_->frameAt(newest - ago()))[*history_->indexOf(trace.module)];
            if (felt.isKnown())
                trace.shown = valueOf(felt, quantity_);
        }
        traces.emplace_back(i, std::move(trace));
    }
    return traces;
}

void DemoPresenter::setForce(double force) {
    force_ = force;
}

void DemoPresenter::touch(ModuleId module, const Vector3d& point_u) {
    if (!canTouch() || !isStreaming())
        return;
    setLive(true);
    workbench_.hands->touch(module, point_u, force_);
}

void DemoPresenter::release() {
    if (workbench_.hands && workbench_.hands->release)
        workbench_.hands->release();
}

}  // namespace skincal
