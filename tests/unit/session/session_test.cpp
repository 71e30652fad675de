#include "core/session/session.h"

#include <gtest/gtest.h>

#include <QSignalSpy>

#include "tests/unit/session/session_samples.h"

namespace skincal {
namespace {

using test::decideSomething;
using test::smallRecording;
using test::textOf;

TEST(Session, UndoingAllGivesTheStateBeforeAndRedoingAllTheStateAfter) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        Session session;
        session.load(smallRecording(seed));
        const std::string measured = textOf(session.measured());
        std::vector<std::string> states{textOf(session.decisions())};
        for (int i = 0; i < 40; ++i) {
            session.decide("something",
                           [&](Decisions& decisions) { decideSomething(session.measured(), random, decisions); });
            if (const std::string state = textOf(session.decisions()); state != states.back())
                states.push_back(state);
        }
        ASSERT_EQ(static_cast<std::size_t>(session.undoStack().count()) + 1, states.size())
            << "what changes nothing is no step";
        for (std::size_t i = states.size() - 1; i-- > 0;) {
            session.undoStack().undo();
            ASSERT_EQ(textOf(session.decisions()), states[i]);
        }
        EXPECT_FALSE(session.undoStack().canUndo());
        for (std::size_t i = 1; i < states.size(); ++i) {
            session.undoStack().redo();
            ASSERT_EQ(textOf(session.decisions()), states[i]);
        }
        for (int i = 0; i < 60; ++i) {
            session.undoStack().setIndex(static_cast<int>(random.index(states.size())));
            ASSERT_EQ(textOf(session.decisions()), states[static_cast<std::size_t>(session.undoStack().index())]);
        }
        EXPECT_EQ(textOf(session.measured()), measured) << "a decision touched what was measured";
    }
}

// Whatever is measured and decided in whatever order: at every step back and forth the same counts as did then.
TEST(Session, WhatIsMeasuredIsUndoneLikeWhatIsDecided) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        Session session;
        session.load(smallRecording(seed));
        const Measured first = session.measured();
        const auto counting = [&] { return textOf(measurementsOf(session.measured(), session.decisions())); };
        std::vector<std::string> states{counting()};
        for (int i = 0; i < 40; ++i) {
            const int before = session.undoStack().count();
            ScannedView view = first.views[random.index(first.views.size())];
            switch (random.index(5)) {
                case 0:
                    session.addPose({first.gravity.begin(), first.gravity.begin() + 5});
                    break;
                case 1:
                    session.addView(view);
                    break;
                case 2:
                    view.decoded.found.resize(1 + random.index(view.decoded.found.size()));
                    session.replaceView(view);
                    break;
                default:
                    session.decide("something", [&](Decisions& decisions) {
                        decideSomething(session.measured(), random, decisions);
                    });
            }
            if (session.undoStack().count() > before)
                states.push_back(counting());
        }
        ASSERT_EQ(static_cast<std::size_t>(session.undoStack().count()) + 1, states.size());
        const std::size_t readings = session.measured().gravity.size();
        const std::size_t views = session.measured().views.size();
        for (int i = 0; i < 60; ++i) {
            session.undoStack().setIndex(i == 0 ? 0 : static_cast<int>(random.index(states.size())));
            ASSERT_EQ(counting(), states[static_cast<std::size_t>(session.undoStack().index())]) << seed << ' ' << i;
            ASSERT_EQ(session.measured().gravity.size(), readings) << "nothing is lost";
            ASSERT_EQ(session.measured().views.size(), views);
        }
    }
}

TEST(Session, ACaptureThatWasUndoneStaysUndoneWhateverElseIs) {
    Session session;
    session.load(smallRecording(1));
    const auto poses = [&] { return posesOf(session.measured(), session.decisions()); };
    const auto atFirst = poses();
    session.decide("drop", [&](Decisions& decisions) { decisions.droppedPoses.insert(atFirst.front()); });
    const int pose = session.addPose({session.measured().gravity.front()});
    EXPECT_EQ(session.undoStack().undoText(), QStringLiteral("Capture pose %1").arg(pose + 1));
    session.undoStack().undo();
    // What is decided now ends what could be redone.
    session.decide("reject a cable", [&](Decisions& decisions) {
        decisions.links[LinkKey::of(session.measured().skin.links.front())] = LinkKind::Cable;
    });
    while (session.undoStack().canUndo())
        session.undoStack().undo();
    EXPECT_EQ(poses(), atFirst);
    session.decide("take it back", [&](Decisions& decisions) { decisions.droppedPoses.erase(pose); });
    EXPECT_EQ(poses().back(), pose) << "it was measured, and is there";
}

TEST(Session, WhatWasDecidedAboutAViewDoesNotHoldForTheNextScanOfIt) {
    Session session;
    session.load(smallRecording(1));
    const ScannedView first = session.measured().views[1];
    const ModuleId module = first.decoded.found.front().module;
    const auto other = session.measured().views[0].name;
    session.decide("reject", [&](Decisions& decisions) {
        decisions.detections[{first.name, module}] = {first.name, module, "rejected", "a lamp"};
        decisions.detections[{other, module}] = {other, module, "rejected", ""};
        decisions.droppedViews.insert(first.name);
    });
    const std::string decided = textOf(session.decisions());
    ScannedView second = first;
    second.pictures = std::make_shared<const Pictures>(3);
    second.decoded.found.pop_back();
    const QSignalSpy scanned(&session, &Session::viewsChanged);
    const QSignalSpy told(&session, &Session::decisionsChanged);
    session.replaceView(second);
    EXPECT_EQ(session.undoStack().undoText(), QStringLiteral("Scan %1 again").arg(first.name.c_str()));
    EXPECT_EQ(session.measured().views[1].pictures, second.pictures);
    EXPECT_EQ(session.decisions().detections.size(), 1U) << "that of the other view holds";
    EXPECT_TRUE(session.decisions().droppedViews.empty()) << "who scans again wants it to count";
    session.undoStack().undo();
    EXPECT_EQ(session.measured().views[1].pictures, first.pictures);
    EXPECT_EQ(textOf(session.measured().views[1].decoded), textOf(first.decoded));
    EXPECT_EQ(textOf(session.decisions()), decided);
    session.undoStack().redo();
    EXPECT_EQ(session.measured().views[1].pictures, second.pictures);
    EXPECT_EQ(session.decisions().detections.size(), 1U);
    EXPECT_EQ(scanned.count(), 3);
    EXPECT_EQ(told.count(), 3);
}

TEST(Session, EveryChangeRaisesTheRevisionAndIsTold) {
    Session session;
    session.load(smallRecording(1));
    const QSignalSpy decided(&session, &Session::decisionsChanged);
    std::uint64_t revision = session.revision();
    EXPECT_FALSE(session.isModified());
    session.decide("nothing", [](Decisions&) {});
    EXPECT_EQ(session.revision(), revision);
    EXPECT_FALSE(session.isModified());
    session.decide("drop", [](Decisions& decisions) { decisions.droppedPoses.insert(0); });
    EXPECT_GT(session.revision(), revision);
    EXPECT_TRUE(session.isModified());
    revision = session.revision();
    session.undoStack().undo();
    EXPECT_GT(session.revision(), revision);
    EXPECT_EQ(decided.count(), 2);
}

TEST(Session, NumbersPosesAndNamesViewsThatAreFree) {
    Session session;
    session.load(smallRecording(1));
    const int last = posesOf(session.measured(), {}).back();
    const ModuleId module = session.measured().skin.modules.front().id;
    EXPECT_EQ(session.addPose({{0, module, Vector3d(0, 0, 9.8), {}, {}}}), last + 1);
    EXPECT_EQ(session.measured().gravity.back().pose, last + 1);
    std::set<std::string> names;
    for (const ScannedView& view : session.measured().views)
        names.insert(view.name);
    for (int i = 0; i < 10; ++i) {
        const std::string name = session.addView({});
        EXPECT_TRUE(names.insert(name).second) << name;
        ASSERT_NE(session.findView(name), nullptr);
        EXPECT_EQ(session.findView(name)->decoded.name, name);
    }
    EXPECT_EQ(session.findView("none"), nullptr);
}

TEST(Session, ReplacesTheViewOfThatNameAlone) {
    Session session;
    session.load(smallRecording(1));
    const Measured before = session.measured();
    ScannedView view;
    view.name = before.views[1].name;
    view.decoded.found = {before.views[1].decoded.found.front()};
    session.replaceView(view);
    ASSERT_EQ(session.measured().views.size(), before.views.size());
    EXPECT_EQ(session.measured().views[1].decoded.found.size(), 1U);
    EXPECT_EQ(session.measured().views[1].decoded.name, view.name);
    EXPECT_EQ(textOf(session.measured().views[0].decoded), textOf(before.views[0].decoded));
    const std::uint64_t revision = session.revision();
    view.name = "none";
    session.replaceView(view);
    EXPECT_EQ(session.revision(), revision);
}

TEST(Session, KeepsWhatWasMeasuredOfTheSameModulesAndForgetsItOfOthers) {
    Session session;
    session.load(smallRecording(1));
    session.decide("drop", [](Decisions& decisions) { decisions.droppedPoses.insert(0); });
    ASSERT_TRUE(test::waitFor([&] { return session.solution() && !session.isSolving(); }));
    Skin skin = session.measured().skin;
    std::reverse(skin.modules.begin(), skin.modules.end());
    skin.links.pop_back();
    session.adoptSkin(skin);
    EXPECT_EQ(session.measured().skin.links.size(), skin.links.size());
    EXPECT_FALSE(session.measured().gravity.empty());
    EXPECT_EQ(session.measured().views.size(), 3U);
    EXPECT_TRUE(session.undoStack().canUndo());

    const QSignalSpy decided(&session, &Session::decisionsChanged);
    const auto camera = session.decisions().camera;
    skin.modules.pop_back();
    session.adoptSkin(skin);
    EXPECT_TRUE(session.measured().gravity.empty());
    EXPECT_TRUE(session.measured().views.empty());
    EXPECT_TRUE(session.decisions().droppedPoses.empty());
    EXPECT_EQ(textOf(session.decisions().camera), textOf(camera)) << "the camera is the same";
    EXPECT_FALSE(session.undoStack().canUndo());
    EXPECT_EQ(session.solution(), nullptr);
    EXPECT_EQ(decided.count(), 1);
    ASSERT_TRUE(test::waitFor([&] { return !session.isSolving(); }));
    EXPECT_EQ(session.solution(), nullptr) << "that of the other skin was still on its way";
}

TEST(Session, HasNoBodyWhereNoPoseCounts) {
    Session session;
    session.load(smallRecording(1));
    ASSERT_TRUE(test::waitFor([&] { return session.solution() && !session.isSolving(); }));
    session.decide("drop all", [&](Decisions& decisions) {
        for (const int pose : posesOf(session.measured(), decisions))
            decisions.droppedPoses.insert(pose);
    });
    ASSERT_TRUE(test::waitFor([&] { return session.solution() == nullptr; }));
    session.undoStack().undo();
    ASSERT_TRUE(test::waitFor([&] { return session.solution() != nullptr; }));
    EXPECT_EQ(session.solution()->revision, session.revision());
}

TEST(Session, GuidanceIsOfTheNewestDataOrNotThere) {
    Session session;
    session.load(smallRecording(1));
    Random random(1);
    int guided = 0;
    QObject::connect(&session, &Session::guidanceChanged, &session, [&] {
        if (!session.guidance())
            return;
        ++guided;
        EXPECT_EQ(session.guidance()->revision, session.revision());
    });
    // Changes at every moment of solving: as soon as there is a body, and as soon as there is guidance.
    for (int i = 0; i < 6; ++i) {
        const int before = guided;
        const std::uint64_t asked = session.revision();
        ASSERT_TRUE(test::waitFor([&] {
            return i % 2 == 0 ? guided > before : session.solution() && session.solution()->revision >= asked;
        }));
        session.decide("something", [&](Decisions& decisions) {
            decideSomething(session.measured(), random, decisions);
            decisions.camera->fx += 0.1;
        });
        EXPECT_EQ(session.guidance(), nullptr);
    }
}

}  // namespace
}  // namespace skincal
