// Whoever reads another language reads nothing but that: a translator of everything stands in for one, and what is
// left in English never went by a translator.

#include <gmock/gmock.h>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAction>
#include <QComboBox>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QRegularExpression>
#include <QSpinBox>
#include <QStatusBar>
#include <QTabWidget>
#include <QTranslator>
#include <set>
#include <string>
#include <vector>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/pages/address_dialog.h"
#include "ui/pages/page.h"
#include "ui/pages/video_dialog.h"
#include "ui/print/report.h"

namespace skincal {
namespace {

/// Says everything in wide letters. What will be filled, and what is markup, stays.
class WideLetters : public QTranslator {
  public:
    [[nodiscard]] bool isEmpty() const override { return false; }
    QString translate(const char* /*context*/, const char* source, const char* /*comment*/, int /*n*/) const override {
        static const QRegularExpression kept(QStringLiteral("%L?[0-9]+|%n|\\{[^}]*\\}|<[^>]*>|&[a-z]+;"));
        const QString text = QString::fromUtf8(source);
        QString wide;
        qsizetype at = 0;
        for (auto matches = kept.globalMatch(text); matches.hasNext();) {
            const auto match = matches.next();
            wide += widened(text.mid(at, match.capturedStart() - at)) + match.captured();
            at = match.capturedEnd();
        }
        return wide + widened(text.mid(at));
    }

  private:
    [[nodiscard]] static QString widened(QString text) {
        for (QChar& c : text) {
            if (c.isLetter() && c.unicode() < 128)
                c = QChar(static_cast<char16_t>(c.unicode() - u'!' + 0xFF01));
        }
        return text;
    }
};

/// Two words of English in a row. One alone is a unit, a name, a key.
bool isEnglish(const QString& text) {
    static const QRegularExpression words(QStringLiteral("[A-Za-z]{2,}[,:;.]? [a-z]{2,}"));
    static const QRegularExpression markup(QStringLiteral("<[^>]*>"));
    QString plain = text;
    return plain.remove(markup).contains(words);
}

class Reader {
  public:
    void read(const QWidget& window, const std::string& where) {
        where_ = where;
        for (const QWidget* widget : window.findChildren<QWidget*>())
            readWidget(*widget);
        for (const QAction* action : window.findChildren<QAction*>()) {
            note(action->text(), "action");
            note(action->toolTip(), "tooltip of an action");
        }
    }
    /// Piece by piece of what has markup.
    void readText(const QString& html, const std::string& where) {
        where_ = where;
        static const QRegularExpression markup(QStringLiteral("<style.*</style>|<[^>]*>"),
                                               QRegularExpression::DotMatchesEverythingOption);
        for (const QString& piece : html.split(markup, Qt::SkipEmptyParts))
            note(piece, "text");
    }
    [[nodiscard]] int count() const { return count_; }
    /// What was left in English, and where.
    [[nodiscard]] const std::vector<std::string>& left() const { return left_; }

  private:
    void note(const QString& text, const std::string& what) {
        count_ += text.isEmpty() ? 0 : 1;
        if (isEnglish(text) && told_.insert(text).second)
            left_.push_back(where_ + ", " + what + ": " + text.toStdString());
    }
    void readWidget(const QWidget& widget) {
        const std::string name = widget.objectName().toStdString();
        note(widget.toolTip(), "tooltip of " + name);
        note(widget.accessibleName(), "name of " + name);
        note(widget.accessibleDescription(), "description of " + name);
        if (const auto* label = qobject_cast<const QLabel*>(&widget))
            note(label->text(), "label " + name);
        if (const auto* button = qobject_cast<const QAbstractButton*>(&widget))
            note(button->text(), "button " + name);
        if (const auto* group = qobject_cast<const QGroupBox*>(&widget))
            note(group->title(), "group " + name);
        if (const auto* edit = qobject_cast<const QLineEdit*>(&widget))
            note(edit->placeholderText(), "placeholder of " + name);
        if (const auto* bar = qobject_cast<const QProgressBar*>(&widget))
            note(bar->format(), "bar " + name);
        if (const auto* spin = qobject_cast<const QSpinBox*>(&widget))
            note(spin->prefix() + spin->suffix() + spin->specialValueText(), "number " + name);
        if (const auto* status = qobject_cast<const QStatusBar*>(&widget))
            note(status->currentMessage(), "status");
        if (widget.isWindow())
            note(widget.windowTitle(), "title " + name);
        if (const auto* box = qobject_cast<const QComboBox*>(&widget)) {
            for (int i = 0; i < box->count(); ++i)
                note(box->itemText(i), "choice of " + name);
        }
        if (const auto* tabs = qobject_cast<const QTabWidget*>(&widget)) {
            for (int i = 0; i < tabs->count(); ++i)
                note(tabs->tabText(i) + u'|' + tabs->tabToolTip(i), "tab of " + name);
        }
        if (const auto* view = qobject_cast<const QAbstractItemView*>(&widget); view != nullptr && view->model())
            readModel(*view->model(), name);
    }
    void readModel(const QAbstractItemModel& model, const std::string& name) {
        for (int column = 0; column < model.columnCount(); ++column) {
            for (const int role : {int(Qt::DisplayRole), int(Qt::ToolTipRole)})
                note(model.headerData(column, Qt::Horizontal, role).toString(), "heading of " + name);
            for (int row = 0; row < model.rowCount(); ++row) {
                const QModelIndex index = model.index(row, column);
                for (const int role : {int(Qt::DisplayRole), int(Qt::ToolTipRole), int(Qt::AccessibleTextRole)})
                    note(index.data(role).toString(), "cell of " + name);
            }
        }
    }

    std::string where_;
    std::set<QString> told_;
    std::vector<std::string> left_;
    int count_ = 0;
};

/// Installed as long as it lives.
class InWideLetters {
  public:
    InWideLetters() { QCoreApplication::installTranslator(&translator_); }
    ~InWideLetters() { QCoreApplication::removeTranslator(&translator_); }
    InWideLetters(const InWideLetters&) = delete;
    InWideLetters& operator=(const InWideLetters&) = delete;

  private:
    WideLetters translator_;
};

TEST(Translated, TheReaderSeesWhatIsNot) {
    const InWideLetters language;
    QWidget window;
    QLabel forgotten(QStringLiteral("a forgotten label"), &window);
    forgotten.setToolTip(QCoreApplication::translate("Test", "Some words that went by: %1").arg("view0"));
    const QLabel filled(QCoreApplication::translate("Test", "Why: %1").arg("nobody knows"), &window);
    const QLabel figure(QStringLiteral("12.5 mm"), &window);
    Reader reader;
    reader.read(window, "here");
    EXPECT_EQ(reader.count(), 4);
    EXPECT_THAT(reader.left(),
                testing::ElementsAre(testing::HasSubstr("forgotten label"), testing::HasSubstr("nobody")));
}

TEST(Translated, EveryTextOfEveryPage) {
    const InWideLetters language;
    DrivenWindow driven;
    Reader reader;
    reader.read(driven.window, "as it begins");
    EXPECT_GT(reader.count(), 200);
    // Much is right in one, and much is wrong in the other.
    Session& session = driven.session();
    for (const char* scenario : {"arm", "faults"}) {
        session.load(openedFrom(recordingOf(buildWorld(*findScenario(scenario), 1))));
        ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved() && session.guidance(); }));
        for (const Step step : kSteps) {
            ASSERT_TRUE(driven.goTo(step));
            reader.read(driven.window, scenario + (' ' + nameOf(step).toStdString()));
        }
        reader.readText(reportHtml(session.solution()->body, {}), "report");
    }
    EXPECT_FALSE(session.solution()->body.quality.findings.empty());
    // What is left of it with one pose and one view: what is missing is told.
    session.decide(QStringLiteral("less"), [&](Decisions& decisions) {
        for (int pose = 1; pose < 20; ++pose)
            decisions.droppedPoses.insert(pose);
        for (std::size_t v = 1; v < session.measured().views.size(); ++v)
            decisions.droppedViews.insert(session.measured().views[v].name);
    });
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    ASSERT_TRUE(driven.connectSkin());
    for (const Step step : kSteps) {
        ASSERT_TRUE(driven.goTo(step));
        reader.read(driven.window, nameOf(step).toStdString() + ", with little");
    }
    EXPECT_GT(reader.count(), 3000);
    EXPECT_THAT(reader.left(), testing::IsEmpty());
}

TEST(Translated, EveryTextOfEveryDialog) {
    const InWideLetters language;
    DrivenWindow driven;
    ASSERT_TRUE(driven.goTo(Step::Camera));
    ASSERT_TRUE(driven.click("calibrateHere"));
    const auto* calibration = driven.find<QDialog>("calibration");
    ASSERT_NE(calibration, nullptr);
    Reader reader;
    reader.read(*calibration, "calibration");
    reader.read(AddressDialog(), "address");
    reader.read(VideoDialog(), "video");
    EXPECT_GT(reader.count(), 50);
    EXPECT_THAT(reader.left(), testing::IsEmpty());
}

}  // namespace
}  // namespace skincal
