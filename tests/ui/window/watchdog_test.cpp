// The watchdog itself: a limit that nothing can break would tell nothing.

#include <gtest/gtest.h>

#include <QTimer>

#include "tests/ui/watchful_application.h"

namespace skincal {
namespace {

void burn(double seconds) {
    const auto now = [] {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const double until = now() + seconds;
    while (now() < until) {
    }
}

TEST(Watchdog, SeesTheEventThatIsTooLongAndWhoseItIs) {
    WatchfulApplication& watchdog = WatchfulApplication::instance();
    watchdog.forget();
    QTimer::singleShot(0, &watchdog, [] { burn(0.002); });
    QCoreApplication::processEvents();
    EXPECT_LT(watchdog.longest().seconds, WatchfulApplication::kLongest);
    bool isDone = false;
    QTimer::singleShot(0, &watchdog, [&] {
        burn(1.2 * WatchfulApplication::kLongest);
        isDone = true;
    });
    while (!isDone)
        QCoreApplication::processEvents();
    EXPECT_GT(watchdog.longest().seconds, WatchfulApplication::kLongest);
    EXPECT_FALSE(watchdog.longest().what.empty());
    watchdog.forget();
    EXPECT_EQ(watchdog.longest().seconds, 0);
}

}  // namespace
}  // namespace skincal
