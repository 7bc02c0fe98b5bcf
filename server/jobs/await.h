// Blocking waits for threads that may wait: the value that a call of the store or of the jobs passes to its callback.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <utility>

namespace tunewright::server {

/// Calls `start` with a callback and returns the value that the callback gets, from any thread.
template <class T, class Start>
T await(const Start& start) {
    const auto promise = std::make_shared<std::promise<T>>();
    start([promise](T value) { promise->set_value(std::move(value)); });
    return promise->get_future().get();
}

/// Waits for a callback without a value, as long as somebody needs it: false if `left` (called from time to time; may
/// be empty) reports that nobody does. The callback may still come later.
template <class Start>
bool await_end(const Start& start, const std::function<bool()>& left = {}) {
    constexpr std::chrono::milliseconds look{250};
    const auto promise = std::make_shared<std::promise<void>>();
    std::future<void> end = promise->get_future();
    start([promise] { promise->set_value(); });
    while (end.wait_for(look) != std::future_status::ready)
        if (left && left()) return false;
    return true;
}

}  // namespace tunewright::server
