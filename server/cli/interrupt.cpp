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
        constexpr timespec kPause{0, 100'000'000};
        while (!ended.stop_requested()) {
            if (sigtimedwait(&waited, nullptr, &kPause) != SIGINT) continue;
            stop_.request_stop();
            pthread_sigmask(SIG_UNBLOCK, &waited, nullptr);
            return;
        }
    });
}

Interrupt::~Interrupt() {
    watcher_ = {};
    const sigset_t signals = interrupt_signal();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace tunewright::server
