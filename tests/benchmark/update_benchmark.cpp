// A body of 1,000 modules and 30 views that is solved again after one more view or one more gravity pose, from the last
// result and from nothing. Run on one core (taskset -c 0) for the time that a window's worker takes.
//   view_s, pose_s        seconds of updateJointly
//   anew_s                seconds of solveJointly on the same data
//   view_ratio            view_s / anew_s, and likewise pose_ratio
//   off_by_sigma          the position that differs most between the two, in standard deviations
//   longest_unpolled_ms   longest time for which updating or solving did not ask whether it is cancelled

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "core/estimation/joint_method.h"
#include "core/simulation/world.h"

namespace {

using namespace skincal;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Notes how long work goes without asking.
class PollWatch {
  public:
    [[nodiscard]] RunContext context() {
        last_ = Clock::now();
        RunContext context;
        context.isCancelled = [this] {
            longest_ = std::max(longest_, secondsSince(last_));
            last_ = Clock::now();
            return false;
        };
        return context;
    }
    [[nodiscard]] double longest() const { return longest_; }

  private:
    Clock::time_point last_;
    double longest_ = 0;
};

/// The solution and how long it took.
struct Timed {
    BodySolution solution;
    double seconds = 0;
};

template <class Solve>
Timed timed(const Solve& solve) {
    const auto start = Clock::now();
    auto solution = solve();
    if (!solution)
        throw std::logic_error("no solution");
    return {*std::move(solution), secondsSince(start)};
}

double farthestOff(const BodySolution& a, const BodySolution& b) {
    double farthest = 0;
    for (std::size_t u = 0; u < a.solved.T_r_u.size(); ++u) {
        const auto& covariance = a.estimate.covariances[u];
        if (!covariance || !a.solved.T_r_u[u] || !b.solved.T_r_u[u])
            continue;
        const double sigma = std::sqrt(covariance->bottomRightCorner<3, 3>().trace() / 3);
        const double off = (a.solved.T_r_u[u]->translation() - b.solved.T_r_u[u]->translation()).norm();
        farthest = std::max(farthest, off / sigma);
    }
    return farthest;
}

void update(benchmark::State& state) {
    const World world = buildWorld(*findScenario("thousand"), 1);
    const Measurements all{world.skin, simulateGravity(world), world.scenario.camera, simulateDetections(world)};
    Measurements withView = all;
    const auto lastPose = all.gravity.back().pose;
    std::erase_if(withView.gravity, [&](const GravityReading& reading) { return reading.pose == lastPose; });
    Measurements first = withView;
    first.views.pop_back();
    const GravityTable before(first.skin, first.gravity);
    const GravityTable after(all.skin, all.gravity);
    const auto start = solveJointly(first, before);
    if (!start)
        throw std::logic_error("no solution");

    PollWatch watch;
    for ([[maybe_unused]] auto iteration : state) {
        const Timed view = timed([&] { return updateJointly(*start, withView, before, {}, watch.context()); });
        const Timed pose = timed([&] { return updateJointly(view.solution, all, after, {}, watch.context()); });
        const Timed anew = timed([&] { return solveJointly(all, after, {}, watch.context()); });
        state.SetIterationTime(view.seconds);
        state.counters["view_s"] = view.seconds;
        state.counters["pose_s"] = pose.seconds;
        state.counters["anew_s"] = anew.seconds;
        state.counters["view_ratio"] = view.seconds / anew.seconds;
        state.counters["pose_ratio"] = pose.seconds / anew.seconds;
        state.counters["off_by_sigma"] = farthestOff(anew.solution, pose.solution);
    }
    state.counters["longest_unpolled_ms"] = 1e3 * watch.longest();
}
BENCHMARK(update)->Iterations(1)->UseManualTime()->Unit(benchmark::kSecond);

}  // namespace
