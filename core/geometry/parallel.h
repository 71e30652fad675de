#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <semaphore>
#include <thread>
#include <vector>

namespace skincal {

/// Calls work(i) for every i below `count`, on as many threads as the machine has processors. For results that do not
/// depend on how many these are, work(i) writes only to what belongs to i, and sums are made afterwards, in order.
/// @param chunk      so many of one thread's turns follow each other; large where each is short.
/// @param meanwhile  meanwhile(i) is called on the caller's own thread before each of its chunks; once it returns false
/// no more chunks begin.
/// @param waiting    waiting() is called on the caller's own thread every few hundredths of a second once there are no
/// more chunks for it, until the others have done theirs.
/// An exception of any call reaches the caller once all threads have ended.
template <class Work, class Meanwhile, class Waiting>
void forEachInParallel(std::size_t count, std::size_t chunk, const Work& work, const Meanwhile& meanwhile,
                       const Waiting& waiting) {
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> stop = false;
    const std::size_t chunks = (count + chunk - 1) / chunk;
    std::vector<std::exception_ptr> errors(
        std::clamp<std::size_t>(std::min<std::size_t>(std::thread::hardware_concurrency(), chunks), 1, 64));
    const auto run = [&](std::size_t self) {
        try {
            for (std::size_t begin = chunk * next++; begin < count && !stop; begin = chunk * next++) {
                if (self == 0 && !meanwhile(begin)) {
                    stop = true;
                    break;
                }
                for (std::size_t i = begin; i < std::min(begin + chunk, count); ++i)
                    work(i);
            }
        } catch (...) {
            errors[self] = std::current_exception();
            stop = true;
        }
    };
    std::counting_semaphore<> ended{0};
    std::vector<std::jthread> others;
    for (std::size_t self = 1; self < errors.size(); ++self) {
        others.emplace_back([&, self] {
            run(self);
            ended.release();
        });
    }
    run(0);
    for (std::size_t left = others.size(); left > 0;) {
        if (ended.try_acquire_for(std::chrono::milliseconds(20)))
            --left;
        else
            waiting();
    }
    others.clear();  // joins
    for (const std::exception_ptr& error : errors) {
        if (error)
            std::rethrow_exception(error);
    }
}

template <class Work, class Meanwhile>
void forEachInParallel(std::size_t count, std::size_t chunk, const Work& work, const Meanwhile& meanwhile) {
    forEachInParallel(count, chunk, work, meanwhile, [] {});
}

template <class Work>
void forEachInParallel(std::size_t count, std::size_t chunk, const Work& work) {
    forEachInParallel(count, chunk, work, [](std::size_t) { return true; });
}

}  // namespace skincal
