#include "ui/window/demo_stage.h"

#include <QKeyEvent>
#include <QLabel>
#include <QLayout>
#include <QScreen>
#include <cmath>

#include "ui/pages/demo_page.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/scene3d/scene_widget.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

constexpr double kOrbit_s = 40;  // once round
constexpr int kHint_ms = 4000;

}  // namespace

DemoStage::DemoStage(DemoPresenter& presenter, DemoPage& page, BodyViewWidget& view, QObject* parent)
    : QObject(parent), presenter_(presenter), page_(page), view_(view), touch_(view) {
    orbit_.setInterval(DemoPresenter::kUpdate_ms);
    connect(&orbit_, &QTimer::timeout, this,
            [this] { view_.scene().orbit(360 * kDegree * DemoPresenter::kUpdate_ms / (1e3 * kOrbit_s), 0); });
    connect(&touch_, &TouchFilter::touched, &presenter, &DemoPresenter::touch);
    connect(&touch_, &TouchFilter::released, &presenter, &DemoPresenter::release);
    connect(&page, &DemoPage::stageChanged, this, &DemoStage::arrange);
    connect(&page, &DemoPage::fullScreenAsked, this, [this] { setFullScreen(!isFullScreen()); });
    connect(&presenter, &DemoPresenter::updated, this, &DemoStage::showPicture);
    connect(&presenter, &DemoPresenter::stateChanged, this, &DemoStage::showSelection);
    connect(&view, &BodyViewWidget::moduleClicked, this, [this](ModuleId module) {
        if (isActive_)
            presenter_.toggleTraced(module);
    });
    view.installEventFilter(this);
}

void DemoStage::arrange() {
    if (presenter_.isActive() != isActive_)
        isActive_ ? leave() : enter();
    touch_.setOn(page_.isTouchOn());
    page_.isOrbiting() ? orbit_.start() : orbit_.stop();
    if (isActive_)
        showPicture();
}

void DemoStage::enter() {
    isActive_ = true;
    before_ = view_.colourMode();
    selectedBefore_ = view_.selected();
    view_.setCellValues({});
    view_.setColourMode(ColourMode::Values);
    // Where the cameras stood says nothing about touch.
    view_.setCamerasShown(false);
    showSelection();
    emit activeChanged(true);
}

void DemoStage::leave() {
    setFullScreen(false);
    isActive_ = false;
    view_.setCellHeights({});
    view_.setContacts({});
    view_.setColourMode(before_);
    view_.setCamerasShown(true);
    view_.setSelected(selectedBefore_);
    emit activeChanged(false);
}

void DemoStage::showPicture() {
    if (!isActive_)
        return;
    view_.setCellValues(presenter_.picture().values);
    view_.setCellHeights(page_.isRaised() ? std::span<const float>(presenter_.picture().heights)
                                          : std::span<const float>());
    view_.setContacts(contactMarks());
}

std::vector<ContactMark> DemoStage::contactMarks() const {
    std::vector<ContactMark> marks;
    const auto& contacts = presenter_.picture().contacts;
    const double longest = 0.35 * view_.layoutShown().radius;
    for (const TouchContact& contact : contacts) {
        // The strongest comes first.
        const double share = contacts.front().force > 0 ? contact.force / contacts.front().force : 1;
        if (!contact.position_r || !contact.normal_r)
            continue;
        // Its board may stand out of the body.
        const ShownModule* module = view_.layoutShown().find(contact.module);
        const auto& heights = presenter_.picture().heights;
        const bool isRaised = page_.isRaised() && module != nullptr && module->index < heights.size() &&
                              std::isfinite(heights[module->index]);
        const double height = isRaised ? heights[module->index] : 0;
        marks.push_back(
            {*contact.position_r + height * *contact.normal_r, *contact.normal_r, (0.4 + 0.6 * share) * longest});
    }
    return marks;
}

void DemoStage::showSelection() {
    if (!isActive_)
        return;
    std::vector<ModuleId> modules;
    for (const auto& module : presenter_.traced()) {
        // What is just being touched shows by itself, and labels would hide it.
        if (module && !presenter_.isFollowing())
            modules.push_back(*module);
    }
    view_.setSelected(std::move(modules));
    const QuantityRange range = rangeOf(presenter_.quantity());
    view_.setValueWords(nameOf(presenter_.quantity()), endOf(range.low, presenter_.quantity()),
                        endOf(range.high, presenter_.quantity()));
}

void DemoStage::setFullScreen(bool full) {
    if (full == isFullScreen() || (full && !isActive_))
        return;
    if (full) {
        QWidget* window = view_.window();
        place_ = new QWidget(view_.parentWidget());
        delete view_.parentWidget()->layout()->replaceWidget(&view_, place_);
        // Still a child of the window, which it goes with.
        view_.setParent(window, Qt::Window);
        view_.setWindowTitle(window->windowTitle());
        // Where no window manager does it.
        view_.setGeometry(window->screen()->geometry());
        view_.showFullScreen();
        view_.activateWindow();
        tellTheWayBack();
    } else {
        QWidget* place = place_;
        place_.clear();
        delete place->parentWidget()->layout()->replaceWidget(place, &view_);
        delete place;
        view_.showNormal();
    }
    view_.setFocus(Qt::OtherFocusReason);
}

void DemoStage::tellTheWayBack() {
    auto* hint = new QLabel(tr("Escape leaves the full screen"), &view_);
    hint->setStyleSheet(QStringLiteral("background: %1; color: %2; padding: 8px 16px; border-radius: 6px;")
                            .arg(Theme::current().panel.name(), Theme::current().text.name()));
    hint->setAttribute(Qt::WA_TransparentForMouseEvents);
    hint->adjustSize();
    hint->move((view_.width() - hint->width()) / 2, 24);
    hint->show();
    QTimer::singleShot(kHint_ms, hint, &QObject::deleteLater);
}

bool DemoStage::eventFilter(QObject* watched, QEvent* event) {
    if (!isFullScreen())
        return QObject::eventFilter(watched, event);
    if (event->type() == QEvent::KeyPress) {
        const int key = static_cast<QKeyEvent*>(event)->key();
        if (key == Qt::Key_Escape || key == Qt::Key_F11) {
            setFullScreen(false);
            return true;
        }
        if (key == Qt::Key_Space) {
            presenter_.setLive(!presenter_.isLive());
            return true;
        }
    } else if (event->type() == QEvent::Close) {
        event->ignore();
        setFullScreen(false);
        return true;
    }
    return QObject::eventFilter(watched, event);
}

}  // namespace skincal
