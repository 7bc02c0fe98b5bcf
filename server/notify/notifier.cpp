#include "server/notify/notifier.h"

#include <algorithm>
#include <random>

#include "server/json_text.h"
#include "server/log.h"
#include "server/notify/schedule.h"
#include "server/notify/signature.h"
#include "server/random.h"

namespace tunewright::server {
namespace {

constexpr std::chrono::milliseconds kWatchInterval{500};  ///< interval of checks of the requests in progress
constexpr int kHttpGone = 410;

static_assert(Notifier::kHold > 2 * Sender::kLongest);

std::string what_ended(const Delivery& delivery) {
    return delivery.batch.empty() ? "job " + delivery.job : "batch " + delivery.batch;
}

/// The part of a URL that a log may show: the rest may be a secret.
std::string shown(const std::string& url) {
    const auto read = parse_address(url);
    const auto* address = std::get_if<WebAddress>(&read);
    return address == nullptr ? "an address that cannot be read" : address->origin();
}

double chance() {
    thread_local std::minstd_rand source{std::random_device{}()};
    return std::uniform_real_distribution<double>()(source);
}

/// The same trace, with a span of its own for this notification (W3C Trace Context).
std::string continued(const std::string& traceparent) {
    constexpr std::size_t kSpanOffset = 36, kSpanLength = 16;
    return std::string(traceparent).replace(kSpanOffset, kSpanLength, random_hex(kSpanLength / 2));
}

}  // namespace

Notifier::Notifier(JobStore& store, NotifyPolicy& policy, NotifierSettings settings)
    : store_(store), policy_(policy), settings_(std::move(settings)) {}

Notifier::~Notifier() { stop(2 * Sender::kLongest); }

void Notifier::start() {
    // Other processes on the same store may be allowed to send where this one is not: it leaves those notifications to
    // them.
    if (store_.shared() && !policy_.allows_any()) return;
    const std::lock_guard lock(mutex_);
    looking_ = std::make_unique<PeriodicThread>([this] { return look(); });
}

void Notifier::wake() {
    const std::lock_guard lock(mutex_);
    if (looking_ && !closed_) looking_->wake();
}

void Notifier::close() { closed_ = true; }

bool Notifier::stop(std::chrono::milliseconds patience) {
    closed_ = true;
    if (looking_) looking_->stop();
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [seq, one] : under_way_) one->sender.cut();
    }
    return delivery_pool_.stop(patience);
}

std::chrono::milliseconds Notifier::look() {
    cut_long_ones();
    if (!closed_) take();
    const std::lock_guard lock(mutex_);
    return under_way_.empty() ? kPoll : kWatchInterval;
}

void Notifier::cut_long_ones() {
    const auto now = DeliveryPool::Clock::now();
    const std::lock_guard lock(mutex_);
    for (const auto& [seq, one] : under_way_)
        if (now - one->since > Sender::kLongest) one->sender.cut();
}

void Notifier::take() {
    const std::size_t max = delivery_pool_.room();
    if (max == 0 || taking_.exchange(true)) return;
    const auto when = DeliveryPool::Clock::now();
    store_.take_deliveries(settings_.now(), kHold, max, [this, when, max](Outcome<std::vector<Delivery>> outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            if (!store_failed_.exchange(true)) log_error("notifications are not sent: " + fault->detail);
            taking_ = false;
            return;
        }
        store_failed_ = false;
        const auto& due = std::get<std::vector<Delivery>>(outcome);
        taken(due, when);
        taking_ = false;
        // There may be more, some of them for other processes.
        if (due.size() == max) wake();
    });
}

/// Notifications that find no room here are offered again when their hold is over.
void Notifier::taken(const std::vector<Delivery>& due, DeliveryPool::Clock::time_point when) {
    if (closed_) return;
    for (const Delivery& delivery : due)
        delivery_pool_.add(
            {shown(delivery.target.url), when + kHold - Sender::kLongest, [this, delivery] { tell(delivery); }});
}

void Notifier::tell(const Delivery& delivery) {
    const auto address = policy_.address_of(delivery.target.url);
    if (const auto* why = std::get_if<std::string>(&address)) return leave_to_others(delivery, *why);
    if (store_.shared() && policy_.secrets(delivery.target.secret_id).empty())
        return leave_to_others(delivery, "there is no secret with its name for the signature");
    const auto& where = std::get<WebAddress>(address);
    std::optional<News> news;
    try {
        news = news_of(delivery);
    } catch (const StoreError& error) {
        log_error(what_ended(delivery) + " cannot be read for its notification: " + error.what());
        return;
    }
    // Deleted, or queued again, meanwhile: there is no end to report.
    if (!news) return settle(delivery, std::nullopt);
    const auto begun = DeliveryPool::Clock::now();
    const Reply reply = send(delivery, where, *news);
    if (reply.status >= 200 && reply.status < 300) {
        const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(DeliveryPool::Clock::now() - begun);
        log_info(what_ended(delivery) + " was reported to " + where.origin() + " in " + std::to_string(took.count()) +
                 " ms, attempt " + std::to_string(delivery.tries + 1));
        settings_.count(DeliveryOutcome::delivered);
        return settle(delivery, std::nullopt);
    }
    if (reply.status == kHttpGone) return give_up(delivery, "it answers 410: it accepts no more notifications");
    std::string why = reply.status == 0 ? reply.fault : "it answers " + std::to_string(reply.status);
    if (reply.status >= 300 && reply.status < 400) why += ", and redirects are not followed";
    failed(delivery, where.origin(), why, read_retry_after(reply.retry_after, settings_.now()));
}

/// Empty if there is nothing to report.
std::optional<Notifier::News> Notifier::news_of(const Delivery& delivery) {
    JsonObject body;
    if (delivery.batch.empty()) {
        const std::optional<JobRecord> job = store_.find(delivery.job);
        if (!job || !has_ended(job->status)) return std::nullopt;
        body.text("type", "job.ended").text("timestamp", iso_time(delivery.created_at));
        return News{std::move(body.raw("data", settings_.job_text(*job))).str(), job->traceparent};
    }
    const std::optional<BatchSummary> batch = store_.find_batch(delivery.batch);
    if (!batch || !batch->ended()) return std::nullopt;
    body.text("type", "batch.ended").text("timestamp", iso_time(delivery.created_at));
    return News{std::move(body.raw("data", settings_.batch_text(*batch))).str(), batch->traceparent};
}

Reply Notifier::send(const Delivery& delivery, const WebAddress& address, const News& news) {
    const std::vector<std::string> secrets = policy_.secrets(delivery.target.secret_id);
    if (secrets.empty()) return {0, "there is no secret with its name for the signature", {}};
    const std::string ended = delivery.batch.empty() ? delivery.job : delivery.batch;
    const SignedNote note{"evt_" + ended + "_" + std::to_string(delivery.seq), settings_.now() / 1000, news.body};
    const auto under_way = std::make_shared<UnderWay>();
    under_way->since = DeliveryPool::Clock::now();
    {
        const std::lock_guard lock(mutex_);
        if (closed_) return {0, "the service is being stopped", {}};
        under_way_.emplace(delivery.seq, under_way);
    }
    OutgoingNote out{address,
                     {{"Content-Type", "application/json"},
                      {"User-Agent", "Tunewright/" + settings_.version},
                      {"webhook-id", note.id},
                      {"webhook-timestamp", std::to_string(note.timestamp)},
                      {"webhook-signature", signature_of(note, secrets)}},
                     news.body};
    if (!news.traceparent.empty()) out.headers.emplace_back("traceparent", continued(news.traceparent));
    Reply reply = under_way->sender.send(std::move(out));
    const std::lock_guard lock(mutex_);
    under_way_.erase(delivery.seq);
    return reply;
}

void Notifier::failed(const Delivery& delivery, const std::string& where, const std::string& why,
                      std::optional<std::chrono::seconds> retry_after) {
    // The attempt was cut off here, or not even begun: the receiver has not failed, and the notification is offered
    // again after its hold.
    if (closed_) return;
    const auto pause = pause_after({delivery.tries, delivery.created_at, settings_.now(), chance(), retry_after});
    if (!pause) return give_up(delivery, why);
    settings_.count(DeliveryOutcome::failed);
    log_info(what_ended(delivery) + " could not be reported to " + where + ": " + why + "; the next attempt is in " +
             std::to_string(pause->count() / 1000) + " s");
    settle(delivery, pause);
}

void Notifier::give_up(const Delivery& delivery, const std::string& why) {
    settings_.count(DeliveryOutcome::given_up);
    log_error(what_ended(delivery) + " will not be reported to " + shown(delivery.target.url) + " any more, after " +
              std::to_string(delivery.tries + 1) + " attempts: " + why);
    settle(delivery, std::nullopt);
}

/// Another process, or this one after a restart, may be allowed to send where this one is not: a notification waits for
/// that as long as for a receiver.
void Notifier::leave_to_others(const Delivery& delivery, const std::string& why) {
    // Random, so that it is not always the same process that comes first.
    const auto min = std::chrono::duration_cast<std::chrono::milliseconds>(kPoll * (0.3 + 2 * chance()));
    const auto pause = pause_for_others({0, delivery.created_at, settings_.now(), chance()}, min);
    if (!pause) return give_up(delivery, why);
    if (!left_some_.exchange(true))
        log_info("notifications that this process may not send (" + why + ") are left to other processes");
    settle(delivery, pause, false);
}

void Notifier::settle(const Delivery& delivery, std::optional<std::chrono::milliseconds> pause, bool tried) {
    store_.settle_delivery(
        delivery.seq, settings_.now(), pause, tried, [what = what_ended(delivery)](const auto& outcome) {
            if (const auto* fault = std::get_if<StoreFault>(&outcome))
                log_error(what +
                          " may be reported again, because the store could not record the delivery: " + fault->detail);
        });
}

}  // namespace tunewright::server
