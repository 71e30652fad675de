#pragma once

#include <mutex>
#include <optional>
#include <utility>

namespace skincal {

/// Holds the newest of something between two threads: what nobody has fetched is replaced, never queued.
template <class Letter>
class Mailbox {
  public:
    /// @return whether it was empty: only then somebody has to be told.
    bool put(Letter letter) {
        const std::scoped_lock lock(mutex_);
        const bool wasEmpty = !letter_;
        letter_ = std::move(letter);
        return wasEmpty;
    }

    [[nodiscard]] std::optional<Letter> take() {
        const std::scoped_lock lock(mutex_);
        return std::exchange(letter_, std::nullopt);
    }

  private:
    std::mutex mutex_;
    std::optional<Letter> letter_;
};

}  // namespace skincal
