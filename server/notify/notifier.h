// Tells those who asked for it that a job or a batch has ended. What is to be told stands in the store, from the
// transaction on that ends the job; here it is taken out, sent, and settled: at least once, in any process on the
// store.
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
    failed,    ///< it is tried again
    given_up,  ///< it is not
};

struct NotifierSettings {
    std::function<UnixMs()> now;  ///< by the store's clock
    /// An ended job, or batch, as `data` shows it.
    std::function<std::string(const JobRecord& job)> job_text;
    std::function<std::string(const BatchSummary& batch)> batch_text;
    std::function<void(DeliveryOutcome outcome)> count;
    std::string version;  ///< of the program
};

class Notifier {
public:
    /// How often the store is asked, when nobody wakes it.
    static constexpr std::chrono::milliseconds kPoll{1000};
    /// What is taken here is nobody else's for so long: longer than the longest try, so that no other process sends it
    /// at the same time. A process that dies gives it back by that.
    static constexpr std::chrono::milliseconds kHold{45'000};

    /// All must outlive it, and the store must have answered each call when it goes.
    Notifier(JobStore& store, NotifyPolicy& policy, NotifierSettings settings);
    ~Notifier();
    Notifier(const Notifier&) = delete;
    Notifier& operator=(const Notifier&) = delete;

    void start();
    /// Something has ended here that somebody may want to hear of.
    void wake();
    /// Nothing more is begun; what is under way goes on.
    void close();
    /// Ends what is under way, which then comes again. True where that was done within `patience`; else it is not to be
    /// destroyed.
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
        std::string traceparent;  ///< of the call that posted what has ended; "" if it had none
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
    std::atomic<bool> left_some_ = false;  ///< to others, which the log has said
    std::mutex mutex_;
    std::map<std::int64_t, std::shared_ptr<UnderWay>> under_way_;  ///< by the delivery
    DeliveryPool delivery_pool_;
    std::unique_ptr<PeriodicThread> looking_;
};

}  // namespace tunewright::server
