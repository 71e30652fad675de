#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QFile>
#include <QRegularExpression>
#include <QXmlStreamReader>

#include "tests/ui/presenters/desk.h"

namespace skincal {
namespace {

using test::Desk;

struct Message {
    QByteArray context;
    QByteArray source;
};

/// All texts that count, as translations/skincal_en.ts lists them. That none is missing there is a test of its own.
std::vector<Message> countingTexts() {
    QFile file(QStringLiteral(SKINCAL_TEST_DATA "/../../translations/skincal_en.ts"));
    EXPECT_TRUE(file.open(QIODevice::ReadOnly));
    QXmlStreamReader xml(&file);
    std::vector<Message> messages;
    QByteArray context;
    while (!xml.atEnd()) {
        if (xml.readNext() != QXmlStreamReader::StartElement)
            continue;
        if (xml.name() == u"name")
            context = xml.readElementText().toUtf8();
        else if (xml.name() == u"source")
            messages.push_back({context, xml.readElementText().toUtf8()});
    }
    EXPECT_FALSE(xml.hasError()) << xml.errorString().toStdString();
    return messages;
}

TEST(PluralForms, NoTextSaysOneOfMany) {
    const QRegularExpression oneOfMany(
        QStringLiteral("\\b1 (\\w+ )?(modules|patches|links|spots|pictures|detections|boards|poses|views)\\b"));
    const auto messages = countingTexts();
    EXPECT_GE(messages.size(), 10U);
    for (const auto& [context, source] : messages) {
        const auto say = [&, &context = context, &source = source](int n) {
            return QCoreApplication::translate(context.constData(), source.constData(), nullptr, n);
        };
        EXPECT_FALSE(oneOfMany.match(say(1)).hasMatch()) << say(1).toStdString();
        EXPECT_NE(say(1), QString::fromUtf8(source).replace(QLatin1String("%n"), QLatin1String("1")))
            << say(1).toStdString() << ": there is no form for one";
        for (const int n : {0, 2, 21})
            EXPECT_EQ(say(n), QString::fromUtf8(source).replace(QLatin1String("%n"), QString::number(n)));
        EXPECT_FALSE(say(1).contains(QLatin1String("%n")));
    }
}

TEST(PluralForms, ReachWhatPresentersSay) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.startCamera());
    ASSERT_TRUE(desk.scanHere());
    auto& detections = desk.scan.detections();
    ASSERT_GE(detections.rows().size(), 2U);
    detections.reject({detections.rows()[0].module});
    EXPECT_EQ(desk.session().undoStack().undoText(), "Reject 1 detection in view0");
    detections.reject({detections.rows()[0].module, detections.rows()[1].module});
    EXPECT_EQ(desk.session().undoStack().undoText(), "Reject 2 detections in view0");
}

}  // namespace
}  // namespace skincal
