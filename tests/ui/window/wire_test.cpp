#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QComboBox>
#include <QDialogButtonBox>
#include <QDir>
#include <QLineEdit>
#include <QTemporaryDir>

#include "core/device/protocol/frame.h"
#include "core/rig/pseudo_terminal.h"
#include "core/rig/wired_skin.h"
#include "tests/ui/window/driven_window.h"
#include "ui/pages/address_dialog.h"

namespace skincal {
namespace {

/// The window, and a virtual skin at the end of a pseudo-terminal.
class WireWindow : public testing::Test {
  protected:
    WireWindow() : driven("demo"), desk(*findScenario("demo"), 1), wired(desk, {}) {
        link = QDir(directory.path()).filePath(QStringLiteral("skin"));
        EXPECT_EQ(terminal.open(link), QString());
        QObject::connect(&terminal, &PseudoTerminal::received, &wired, &WiredSkin::receive);
        QObject::connect(&wired, &WiredSkin::sent, &terminal, &PseudoTerminal::write);
        devices = driven.find<QComboBox>("skins");
    }

    /// What this cell says of itself arrives and makes no sense from now on.
    void muffle(std::uint16_t cell) {
        QObject::disconnect(&wired, &WiredSkin::sent, &terminal, &PseudoTerminal::write);
        QObject::connect(&wired, &WiredSkin::sent, &terminal, [this, cell](const QByteArray& sent) {
            std::vector<std::uint8_t> bytes;
            decoder.feed({reinterpret_cast<const std::uint8_t*>(sent.data()), static_cast<std::size_t>(sent.size())},
                         [&](const FrameHeader& header, std::string_view payload) {
                             const bool isMuffled = header.type == FrameType::CellInfo && header.first == cell;
                             appendFrame(header, isMuffled ? std::string_view() : payload, bytes);
                         });
            terminal.write(QByteArray(reinterpret_cast<const char*>(bytes.data()), static_cast<int>(bytes.size())));
        });
    }

    void typeAddress(const QString& text) {
        const int last = devices->count() - 1;
        devices->setCurrentIndex(last);
        emit devices->activated(last);
        auto* dialog = driven.window.findChild<AddressDialog*>();
        ASSERT_NE(dialog, nullptr);
        QPushButton* use = dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
        EXPECT_FALSE(use->isEnabled());
        dialog->findChild<QLineEdit*>("address")->setText(text);
        driven.takePictureOf(*dialog, "address-dialog");
        ASSERT_TRUE(use->isEnabled());
        QTest::mouseClick(use, Qt::LeftButton);
        ASSERT_TRUE(driven.waitFor([&] { return devices->currentText() == text; }));
    }
    [[nodiscard]] QString problems() {
        QString all;
        for (int row = 0; row < driven.window.problems().rowCount(); ++row)
            all += driven.window.problems().index(row).data().toString() + QLatin1Char('\n');
        return all;
    }
    [[nodiscard]] std::size_t modules() { return driven.session().measured().skin.modules.size(); }

    QTemporaryDir directory;
    QString link;
    DrivenWindow driven;
    SimulatedRig desk;
    WiredSkin wired;
    PseudoTerminal terminal;
    FrameDecoder decoder;
    QComboBox* devices = nullptr;
};

TEST_F(WireWindow, ASkinAtATypedAddressIsExploredAndComesBackByItself) {
    typeAddress(link);
    ASSERT_TRUE(driven.click("connect"));
    ASSERT_TRUE(driven.waitFor([&] { return driven.workbench.isSkinReady(); }));
    EXPECT_EQ(modules(), desk.world().skin.modules.size());
    driven.takePicture("wired");
    terminal.close();
    ASSERT_TRUE(driven.waitFor([&] { return !driven.workbench.isSkinReady(); }));
    EXPECT_EQ(modules(), desk.world().skin.modules.size()) << "what was found stays";
    ASSERT_EQ(terminal.open(link), QString());
    ASSERT_TRUE(driven.waitFor([&] { return driven.workbench.isSkinReady(); }));
    EXPECT_EQ(modules(), desk.world().skin.modules.size());
}

TEST_F(WireWindow, NamesModulesThatAreThereAndSayNothing) {
    muffle(2);
    typeAddress(link);
    ASSERT_TRUE(driven.click("connect"));
    ASSERT_TRUE(driven.waitFor([&] { return driven.workbench.isSkinReady(); }));
    EXPECT_EQ(modules(), desk.world().skin.modules.size() - 1);
    ASSERT_TRUE(problems().contains("1 module did not answer: beside module ")) << problems().toStdString();
    const ProblemModel& list = driven.window.problems();
    int row = 0;
    while (!list.problemAt(row).text.contains("did not answer"))
        ++row;
    EXPECT_EQ(list.problemAt(row).step, Step::Connect);
    // Number 1 gave it its number.
    const auto& beside = list.problemAt(row).modules;
    EXPECT_TRUE(std::count(beside.begin(), beside.end(), ModuleId(1)) == 1) << beside.size();
    driven.takePicture("wired-silent");
}

TEST_F(WireWindow, SaysWhatToDoWhereNothingAnswers) {
    typeAddress(directory.filePath("nothing"));
    ASSERT_TRUE(driven.click("connect"));
    ASSERT_TRUE(driven.waitFor([&] { return problems().contains("plugged in"); }));
    driven.takePicture("wired-nothing");
}

}  // namespace
}  // namespace skincal
