#include "core/session/solver.h"

#include <gtest/gtest.h>

#include "core/estimation/joint_method.h"
#include "tests/unit/session/session_samples.h"

namespace skincal {
namespace {

using test::decideSomething;
using test::smallRecording;
using test::textOf;
using test::waitFor;

/// The body of a session's present data, computed here and now.
BodyModel expectedBody(const Session& session) {
    const Measurements measurements = measurementsOf(session.measured(), session.decisions());
    const GravityTable gravity(measurements.skin, measurements.gravity);
    const auto solved = solveJointly(measurements, gravity);
    EXPECT_TRUE(solved);
    return describeSolution(*solved, JointMethodOptions().start.initial.pose);
}

bool isSolved(const Session& session) {
    return session.solution() && session.solution()->revision == session.revision();
}

TEST(Solver, NewestRequestWins) {
    std::vector<std::shared_ptr<const Measurements>> requests;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto [measured, decisions] = smallRecording(seed);
        requests.push_back(std::make_shared<const Measurements>(measurementsOf(measured, decisions)));
    }
    Solver solver;
    std::vector<std::shared_ptr<const Solution>> solutions;
    QObject::connect(&solver, &Solver::solved, &solver, [&](std::shared_ptr<const Solution> solution) {
        EXPECT_EQ(solution->measurements, requests.at(solution->revision)) << "a result of another request's";
        solutions.push_back(std::move(solution));
    });
    for (std::size_t i = 0; i < requests.size(); ++i)
        solver.request(requests[i], i, false);
    EXPECT_TRUE(solver.isBusy());
    ASSERT_TRUE(waitFor([&] { return !solver.isBusy(); }));
    ASSERT_FALSE(solutions.empty());
    EXPECT_LE(solutions.size(), 2U) << "those between the first and the last are never begun";
    EXPECT_EQ(solutions.back()->revision, requests.size() - 1);
}

TEST(Solver, ForgetsWhatItWasAskedBeforeAReset) {
    const auto [measured, decisions] = smallRecording(1);
    const auto measurements = std::make_shared<const Measurements>(measurementsOf(measured, decisions));
    Solver solver;
    std::vector<std::uint64_t> revisions;
    QObject::connect(&solver, &Solver::solved, &solver,
                     [&](const std::shared_ptr<const Solution>& s) { revisions.push_back(s->revision); });
    QObject::connect(&solver, &Solver::guided, &solver,
                     [&](const std::shared_ptr<const Guidance>& g) { EXPECT_EQ(g->revision, 3U); });
    solver.request(measurements, 1, false);
    solver.request(measurements, 2, false);
    solver.reset();
    solver.request(measurements, 3, false);
    ASSERT_TRUE(waitFor([&] { return !solver.isBusy(); }));
    EXPECT_EQ(revisions, std::vector<std::uint64_t>{3});
    solver.request(measurements, 4, false);
    solver.reset();
    ASSERT_TRUE(waitFor([&] { return !solver.isBusy(); }));
    EXPECT_EQ(revisions.size(), 1U);
}

TEST(Solver, AfterQuickChangesTheBodyIsThatOfTheNewestData) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Random random(seed);
        Session session;
        session.load(smallRecording(seed));
        for (int burst = 0; burst < 4; ++burst) {
            for (int i = 0; i < 5; ++i) {
                session.decide("something", [&](Decisions& decisions) {
                    decideSomething(session.measured(), random, decisions);
                    decisions.camera->fx += 0.01;
                });
                if (random.index(2) == 0)
                    QCoreApplication::processEvents();
            }
        }
        ASSERT_TRUE(waitFor([&] { return isSolved(session); }));
        EXPECT_EQ(textOf(session.solution()->body), textOf(expectedBody(session)));
        EXPECT_EQ(textOf(*session.solution()->measurements),
                  textOf(measurementsOf(session.measured(), session.decisions())));
    }
}

TEST(Solver, UpdatesOnlyWhereNothingButGrowthCameSince) {
    OpenedRecording recording = smallRecording(1);
    const Measured all = recording.measured;
    std::erase_if(recording.measured.gravity, [](const GravityReading& r) { return r.pose > 3; });
    Session session;
    session.setQuick(0);  // everything is slow
    session.load(recording);
    ASSERT_TRUE(waitFor([&] { return isSolved(session); }));
    EXPECT_FALSE(session.solution()->isUpdate) << "there was nothing before";
    int next = 4;
    const auto addPose = [&] {
        std::vector<GravityReading> readings;
        for (const GravityReading& r : all.gravity) {
            if (r.pose == next)
                readings.push_back(r);
        }
        ++next;
        session.addPose(std::move(readings));
    };
    addPose();
    ASSERT_TRUE(waitFor([&] { return isSolved(session); }));
    EXPECT_TRUE(session.solution()->isUpdate) << "else this test tests nothing";

    // A change that is no growth, in the same turn of the event loop, in an earlier one, and while it is solved.
    session.decide("drop", [](Decisions& decisions) { decisions.droppedPoses.insert(0); });
    addPose();
    ASSERT_TRUE(waitFor([&] { return isSolved(session); }));
    EXPECT_FALSE(session.solution()->isUpdate);
    session.undoStack().undo();
    QCoreApplication::processEvents();
    addPose();
    ASSERT_TRUE(waitFor([&] { return isSolved(session); }));
    EXPECT_FALSE(session.solution()->isUpdate);

    // Nothing is solved where no pose counts; the change must not be forgotten over that.
    const auto poses = posesOf(session.measured(), session.decisions());
    session.decide("drop all", [&](Decisions& decisions) { decisions.droppedPoses = {poses.begin(), poses.end()}; });
    QCoreApplication::processEvents();
    addPose();
    ASSERT_TRUE(waitFor([&] { return isSolved(session); }));
    EXPECT_FALSE(session.solution()->isUpdate);
    EXPECT_EQ(textOf(session.solution()->body), textOf(expectedBody(session)));
}

TEST(Solver, MayBeDestroyedAtAnyTime) {
    const OpenedRecording recording = smallRecording(1);
    for (int moment = 0; moment < 40; ++moment) {
        auto session = std::make_unique<Session>();
        session->load(recording);
        if (moment == 39) {
            ASSERT_TRUE(waitFor([&] { return session->solution() != nullptr; }));
        }
        // As many turns of the event loop: before it is begun, while it is solved, with results on their way.
        for (int turn = 0; turn < moment; ++turn)
            QCoreApplication::processEvents();
        session.reset();
        QCoreApplication::processEvents();
    }
}

TEST(Solver, MayBeDestroyedByWhoHearsOfABody) {
    auto session = std::make_unique<Session>();
    session->load(smallRecording(1));
    bool heard = false;
    QObject::connect(session.get(), &Session::solutionChanged, qApp, [&] {
        heard = true;
        session.release()->deleteLater();
    });
    ASSERT_TRUE(waitFor([&] { return heard; }));
    QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
    QCoreApplication::processEvents();
}

TEST(Solver, SaysWhyThereIsNoBody) {
    OpenedRecording recording = smallRecording(1);
    for (GravityReading& reading : recording.measured.gravity)
        reading.acceleration = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    Session session;
    session.load(recording);
    ASSERT_TRUE(waitFor([&] { return !session.failure().empty() || isSolved(session); }));
    ASSERT_TRUE(waitFor([&] { return !session.isSolving(); }));
}

TEST(Solver, ABodyIsStaleWhileNewerDataGiveNone) {
    Session session;
    session.load(smallRecording(1));
    ASSERT_TRUE(waitFor([&] { return isSolved(session) && !session.isSolving(); }));
    EXPECT_FALSE(session.isStale());
    const auto body = session.solution();
    std::vector<GravityReading> broken = session.measured().gravity;
    for (GravityReading& reading : broken)
        reading.acceleration = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    const int pose = session.addPose(broken);
    EXPECT_TRUE(session.isStale()) << "nothing has been computed yet";
    ASSERT_TRUE(waitFor([&] { return !session.failure().empty(); }));
    ASSERT_TRUE(waitFor([&] { return !session.isSolving(); }));
    EXPECT_TRUE(session.isStale()) << "though nothing is being computed";
    EXPECT_EQ(session.solution(), body);
    session.decide("drop", [&](Decisions& decisions) { decisions.droppedPoses.insert(pose); });
    ASSERT_TRUE(waitFor([&] { return !session.isStale(); }));
    EXPECT_TRUE(session.failure().empty());
}

}  // namespace
}  // namespace skincal
