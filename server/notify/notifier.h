// Delivers notifications of ended jobs and batches. A notification is stored in the transaction that ends its job; here
// it is read, sent and settled: at least once, in any process on the store.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/notify/delivery_pool.h"
#include "server/notify/policy.h"
#include "server/notify/sender.h"
#include "server/store/store.h"
#include "server/threads/periodic_thread.h"

namespace tunewright::server {

enum class DeliveryOutcome {
    delivered,
    failed,    ///< failed, and will be tried again
    given_up,  ///< failed, and will not be tried again
};

struct NotifierSettings {
    std::function<UnixMs()> now;  ///< time of the store's clock
    /// An ended job, or batch, in the form of `data`.
    std::function<std::string(const JobRecord& job)> job_text;
    std::function<std::string(const BatchSummary& batch)> batch_text;
    std::function<void(DeliveryOutcome outcome)> count;
    std::string version;  ///< of the program
};

class Notifier {
public:
    /// The interval at which the store is asked if nothing else wakes the notifier.
    static constexpr std::chrono::milliseconds kPoll{1000};
    /// A notification taken here is reserved for this long: longer than the longest attempt, so that no other process
    /// sends it at the same time. If the process dies, it becomes available again after that.
    static constexpr std::chrono::milliseconds kHold{45'000};

    /// All references must outlive it, and the store must have answered each call before its destruction.
    Notifier(JobStore& store, NotifyPolicy& policy, NotifierSettings settings);
    ~Notifier();
    Notifier(const Notifier&) = delete;
    Notifier& operator=(const Notifier&) = delete;

    void start();
    /// A job or batch has ended here that may have a notification.
    void wake();
    /// Starts no more deliveries; those in progress continue.
    void close();
    /// Ends deliveries in progress, which are then offered again. True if that was done within `patience`; otherwise
    /// the object must not be destroyed.
    bool stop(std::chrono::milliseconds patience);

private:
    struct UnderWay {
        Sender sender;
        DeliveryPool::Clock::time_point since;
    };

    std::chrono::milliseconds look();
    void take();
    void taken(const std::vector<Delivery>& due, DeliveryPool::Clock::time_point when);
    void tell(const Delivery& delivery);
    struct News {
        std::string body;
        std::string traceparent;  ///< of the call that posted the job; "" if it had none
    };
    std::optional<News> news_of(const Delivery& delivery);
    Reply send(const Delivery& delivery, const WebAddress& address, const News& news);
    void settle(const Delivery& delivery, std::optional<std::chrono::milliseconds> pause, bool tried = true);
    void leave_to_others(const Delivery& delivery, const std::string& why);
    void give_up(const Delivery& delivery, const std::string& why);
    void failed(const Delivery& delivery, const std::string& where, const std::string& why,
                std::optional<std::chrono::seconds> retry_after = {});
    void cut_long_ones();

    JobStore& store_;
    NotifyPolicy& policy_;
    NotifierSettings settings_;
    std::atomic<bool> closed_ = false;
    std::atomic<bool> taking_ = false;
    std::atomic<bool> store_failed_ = false;
    std::atomic<bool> left_some_ = false;  ///< notifications were left to other processes, which the log has reported
    std::mutex mutex_;
    std::map<std::int64_t, std::shared_ptr<UnderWay>> under_way_;  ///< by the number of the delivery
    DeliveryPool delivery_pool_;
    std::unique_ptr<PeriodicThread> looking_;
};

}  // namespace tunewright::server
