// For those who have a thread to wait with: the value that a call of the store or of the jobs hands to its callback.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <utility>

namespace tunewright::server {

/// Calls `start` with a callback and returns what that is called with, from whatever thread.
template <class T, class Start>
T await(const Start& start) {
    const auto promise = std::make_shared<std::promise<T>>();
    start([promise](T value) { promise->set_value(std::move(value)); });
    return promise->get_future().get();
}

/// The same for a callback without a value, as long as somebody waits: false where `left` (asked now and then; may be
/// empty) says that nobody does. The callback may come later all the same.
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
