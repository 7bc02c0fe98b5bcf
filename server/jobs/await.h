// For those who have a thread to wait with: the value that a call of the store or of the jobs hands to its callback.
#pragma once

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

/// The same for a callback without a value.
template <class Start>
void await_end(const Start& start) {
    const auto promise = std::make_shared<std::promise<void>>();
    start([promise] { promise->set_value(); });
    promise->get_future().get();
}

}  // namespace tunewright::server
