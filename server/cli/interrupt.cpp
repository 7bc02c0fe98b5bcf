#include "server/cli/interrupt.h"

#include <csignal>
#include <ctime>

namespace tunewright::server {
namespace {

sigset_t interrupt_signal() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    return signals;
}

}  // namespace

Interrupt::Interrupt() {
    const sigset_t signals = interrupt_signal();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    watcher_ = std::jthread([this](const std::stop_token& ended) {
        const sigset_t waited = interrupt_signal();
        int signal = 0;
        sigwait(&waited, &signal);
        if (ended.stop_requested()) return;
        stop_.request_stop();
        pthread_sigmask(SIG_UNBLOCK, &waited, nullptr);
    });
}

Interrupt::~Interrupt() {
    watcher_.request_stop();
    // Wakes the watcher, which is the only thread that gets this signal.
    if (!stop_.stop_requested()) pthread_kill(watcher_.native_handle(), SIGINT);
    watcher_ = {};
    const sigset_t signals = interrupt_signal();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace tunewright::server
