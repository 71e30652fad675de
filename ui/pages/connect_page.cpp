#include "ui/pages/connect_page.h"

#include <QComboBox>
#include <QHeaderView>
#include <QPushButton>
#include <QSplitter>
#include <QTableView>
#include <algorithm>

#include "ui/pages/address_dialog.h"
#include "ui/presenters/skin_offer.h"
#include "ui/widgets/network_view.h"
#include "ui/widgets/primary_button.h"

namespace skincal {
namespace {

constexpr int kShownLetters = 18;  // of the names of devices, which may be long

}  // namespace

ConnectPage::ConnectPage(Workbench& workbench, ConnectPresenter& presenter, QWidget* parent)
    : Page(tr("Connect"),
           tr("Find out which modules there are and how they are wired. Click a module to let its LED blink."), parent),
      workbench_(workbench),
      presenter_(presenter),
      devices_(new QComboBox),
      connect_(new QPushButton),
      status_(mutedLabel()),
      network_(new NetworkView),
      links_(new QTableView),
      callCable_(new QPushButton(tr("It is a cable"))),
      callNeighbours_(new QPushButton(tr("They are neighbours"))),
      askData_(new QPushButton(tr("Let the data judge"))) {
    auto* top = new QHBoxLayout;
    devices_->setAccessibleName(tr("Skin"));
    devices_->setToolTip(tr("The skin to calibrate"));
    devices_->setObjectName(QStringLiteral("skins"));
    devices_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    devices_->setMinimumContentsLength(kShownLetters);
    connect_->setObjectName(QStringLiteral("connect"));
    connect_->setToolTip(tr("Open the skin and explore its network"));
    top->addWidget(devices_);
    top->addWidget(connect_);
    top->addWidget(status_, 1);
    body().addLayout(top);

    network_->setPlaceholder(tr("Modules appear here once the skin is connected."));
    links_->setModel(&presenter.links());
    links_->setAccessibleName(tr("Links"));
    links_->setToolTip(tr(
        "Every link, whether it was judged a cable or joins neighbours, and why: a wrong verdict puts patches in the "
        "wrong place. Select one to overrule it."));
    links_->setSelectionBehavior(QAbstractItemView::SelectRows);
    links_->setSelectionMode(QAbstractItemView::SingleSelection);
    links_->verticalHeader()->hide();
    links_->horizontalHeader()->setStretchLastSection(true);
    links_->setColumnWidth(LinkModel::From, 90);
    links_->setColumnWidth(LinkModel::To, 90);
    links_->setColumnWidth(LinkModel::Verdict, 150);
    links_->setWordWrap(false);
    auto* below = new QWidget;
    auto* column = new QVBoxLayout(below);
    column->setContentsMargins(0, 4, 0, 0);
    column->addWidget(links_, 1);
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(mutedLabel(tr("Select a link to overrule how it was judged.")), 1);
    links_->setObjectName(QStringLiteral("links"));
    callCable_->setObjectName(QStringLiteral("callCable"));
    callNeighbours_->setObjectName(QStringLiteral("callNeighbours"));
    callCable_->setToolTip(tr("The selected link joins modules that do not touch, whatever the data say"));
    callNeighbours_->setToolTip(tr("The selected link joins modules side by side, whatever the data say"));
    askData_->setToolTip(tr("Forget your word on the selected link"));
    for (QPushButton* button : {callCable_, callNeighbours_, askData_})
        buttons->addWidget(button);
    column->addLayout(buttons);
    auto* splitter = new QSplitter(Qt::Vertical);
    splitter->addWidget(network_);
    splitter->addWidget(below);
    splitter->setStretchFactor(0, 3);
    splitter->setStretchFactor(1, 2);
    splitter->setChildrenCollapsible(false);
    body().addWidget(splitter, 1);

    connect(devices_, &QComboBox::activated, this, &ConnectPage::chooseDevice);
    connect(&workbench, &Workbench::skinOffersChanged, this, &ConnectPage::listDevices);
    connect(&workbench, &Workbench::skinChosen, this,
            [this] { devices_->setCurrentIndex(std::max(workbench_.chosenSkin(), 0)); });
    connect(connect_, &QPushButton::clicked, this, [this] {
        const bool isBusy = presenter_.state().phase == Connection::Phase::Opening ||
                            presenter_.state().phase == Connection::Phase::Exploring;
        isBusy || workbench_.isSkinReady() ? presenter_.disconnectSkin() : presenter_.connectSkin();
    });
    connect(&presenter, &ConnectPresenter::stateChanged, this, &ConnectPage::refresh);
    connect(&presenter, &ConnectPresenter::blinking, this,
            [this](ModuleId module, bool on) { network_->setLit(on ? std::optional(module) : std::nullopt); });
    connect(&presenter.links(), &QAbstractItemModel::modelReset, this, &ConnectPage::showNetwork);
    connect(network_, &NetworkView::moduleClicked, this, [this](ModuleId module) {
        network_->setSelected(module);
        presenter_.blink(module);
        emit moduleSelected(module);
    });
    connect(callCable_, &QPushButton::clicked, this, [this] { overruleSelected(LinkKind::Cable); });
    connect(callNeighbours_, &QPushButton::clicked, this, [this] { overruleSelected(LinkKind::Adjacent); });
    connect(askData_, &QPushButton::clicked, this, [this] { overruleSelected(std::nullopt); });
    connect(links_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &ConnectPage::refresh);
    listDevices();
    showNetwork();
    refresh();
}

void ConnectPage::listDevices() {
    devices_->clear();
    for (const auto& offer : workbench_.skinOffers) {
        devices_->addItem(offer.name);
        devices_->setItemData(devices_->count() - 1, offer.description, Qt::ToolTipRole);
    }
    devices_->insertSeparator(devices_->count());
    devices_->addItem(tr("Another address …"));
    devices_->setItemData(devices_->count() - 1, tr("Another speed, a gateway in the network, a bridge"),
                          Qt::ToolTipRole);
    devices_->setCurrentIndex(std::max(workbench_.chosenSkin(), 0));
}

void ConnectPage::chooseDevice(int offer) {
    if (offer < static_cast<int>(workbench_.skinOffers.size())) {
        presenter_.chooseDevice(offer);
        return;
    }
    devices_->setCurrentIndex(std::max(workbench_.chosenSkin(), 0));
    askForAddress();
}

void ConnectPage::askForAddress() {
    auto* dialog = new AddressDialog(this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, this, [this, dialog] {
        if (const auto address = dialog->address())
            useAddress(*address);
    });
    dialog->open();
}

void ConnectPage::useAddress(const LineAddress& address) {
    Offer<SkinDevice> typed = offerOfAddress(address, workbench_.moduleTypes);
    auto offers = workbench_.skinOffers;
    const auto known =
        std::find_if(offers.begin(), offers.end(), [&](const auto& offer) { return offer.key == typed.key; });
    const auto index = static_cast<int>(known - offers.begin());
    if (known == offers.end()) {
        offers.push_back(std::move(typed));
        workbench_.setSkinOffers(std::move(offers));
    }
    presenter_.chooseDevice(index);
}

void ConnectPage::refresh() {
    using Phase = Connection::Phase;
    const Connection& state = presenter_.state();
    const Skin& skin = workbench_.session().measured().skin;
    QString text;
    switch (state.phase) {
        case Phase::Disconnected:
            text = skin.modules.empty()
                       ? tr("Not connected")
                       : tr("Not connected; %n modules are known", nullptr, static_cast<int>(skin.modules.size()));
            break;
        case Phase::Opening:
            text = tr("Opening …");
            break;
        case Phase::Exploring:
            text = tr("Exploring: %n modules found", nullptr, static_cast<int>(state.found));
            break;
        case Phase::Connected:
            text = tr("%n modules, ", nullptr, static_cast<int>(skin.modules.size())) +
                   tr("%n links", nullptr, static_cast<int>(skin.links.size()));
            break;
        case Phase::Lost:
            text = presenter_.why();
            break;
    }
    status_->setText(text);
    const bool isIdle = state.phase == Phase::Disconnected || state.phase == Phase::Lost;
    connect_->setText(isIdle ? tr("Connect") : state.phase == Phase::Connected ? tr("Disconnect") : tr("Cancel"));
    // Once there is a skin, the next thing is the next step.
    setPrimary(connect_, isIdle);
    devices_->setEnabled(isIdle);
    const QModelIndexList rows = links_->selectionModel()->selectedRows();
    const JudgedLink* link =
        rows.isEmpty() ? nullptr : &presenter_.links().links()[static_cast<std::size_t>(rows.first().row())];
    callCable_->setEnabled(link != nullptr && link->kind != LinkKind::Cable);
    callNeighbours_->setEnabled(link != nullptr && link->kind != LinkKind::Adjacent);
    askData_->setEnabled(link != nullptr && link->isOperatorsWord);
}

void ConnectPage::showNetwork() {
    const Skin& skin = workbench_.session().measured().skin;
    network_->setNetwork(layOutFlat(skin, presenter_.links().links()));
    std::set<ModuleId> faulty;
    for (const WiringFault& fault : wiringFaults(skin))
        faulty.insert(fault.modules.begin(), fault.modules.end());
    network_->setFaulty(std::move(faulty));
    refresh();
}

void ConnectPage::overruleSelected(std::optional<LinkKind> kind) {
    const QModelIndexList rows = links_->selectionModel()->selectedRows();
    if (!rows.isEmpty())
        presenter_.links().overrule(rows.first().row(), kind);
}

}  // namespace skincal
