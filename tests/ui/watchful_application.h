#pragma once

#include <QApplication>
#include <QEvent>
#include <ctime>
#include <string>

namespace skincal {

/// Watches how long single events keep the window from everything else: processor time of the GUI's thread, which does
/// not count what other programs take.
class WatchfulApplication : public QApplication {
  public:
    using QApplication::QApplication;

    struct Stall {
        double seconds = 0;
        std::string what;  ///< receiver and number of the event
    };

    bool notify(QObject* receiver, QEvent* event) override {
        if (depth_ > 0)
            return QApplication::notify(receiver, event);
        const std::string what =
            std::string(receiver->metaObject()->className()) + ", event " + std::to_string(event->type());
        const double before = now();
        ++depth_;
        const bool result = QApplication::notify(receiver, event);
        --depth_;
        const double taken = now() - before;
        if (taken > longest_.seconds)
            longest_ = {taken, what};
        return result;
    }

    [[nodiscard]] static WatchfulApplication& instance() { return *static_cast<WatchfulApplication*>(qApp); }
    /// Of all events that a user waits for, none may be longer.
#ifdef __SANITIZE_ADDRESS__
    static constexpr double kLongest = 0.5;  // what is watched over takes several times as long
#else
    static constexpr double kLongest = 0.05;
#endif

    [[nodiscard]] const Stall& longest() const {
        return longest_;
    }
    void forget() {
        longest_ = {};
    }

  private:
    static double now() {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

    int depth_ = 0;
    Stall longest_;
};

}  // namespace skincal
