// Changes to all entries of a batch, and sweeping, in slices: each takes some milliseconds of the one writing thread,
// so that other changes do not wait for a large batch. Common to all stores; each store has its own functions for one
// slice, selected by the type of its context (a connection inside a transaction).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/store/store.h"

namespace tunewright::server {

/// Entries that one slice touches.
constexpr std::size_t kSliceEntries = 250;

/// The end of a batch's upload. `leaving` is the seq of the batch that has to be deleted: the one that was sent, if the
/// answer is `existing` or `conflict`.
struct SealedBatch {
    Sealed answer;
    std::optional<std::int64_t> leaving;
};

/// The result of BatchStore::remove_batch(). `leaving` is the seq of the batch that has to be deleted, if the effect is
/// `removed`.
struct RemovedBatch {
    RemoveEffect effect = RemoveEffect::none;
    std::int64_t leaving = 0;
};

/// Batches whose changes must be continued.
struct Unsettled {
    std::vector<std::int64_t> leaving;     ///< being deleted; including those whose receiver is silent
    std::vector<std::int64_t> cancelling;  ///< cancelled, but entries still wait
};

/// The functions that a store provides for its Context, in the same namespace:
///
///     SealedBatch seal_batch(Context&, const BatchSeal&);
///     std::optional<std::int64_t> leave_batch(Context&, const std::string& id);   no longer seen from now on
///     RemovedBatch remove_batch(Context&, const std::string& id);
///     std::size_t delete_entries(Context&, std::int64_t batch, std::size_t most); at the end the batch: 0
///     std::optional<std::int64_t> begin_cancel(Context&, const std::string& id);
///     std::optional<std::int64_t> cancel_entries(Context&, std::int64_t batch, std::int64_t from, UnixMs now);
///         one slice from that index on: where the next begins, or nothing after the last
///     std::vector<std::string> end_cancel(Context&, std::int64_t batch);          running entries are asked to stop
///     std::size_t sweep_slice(Context&, UnixMs now, const Retention&, std::size_t most);   0: nothing is left
template <class Context>
class Slices {
public:
    using Finished = std::function<void(std::optional<StoreFault>)>;
    using Ids = std::vector<std::string>;
    /// Queues a change behind the other bulky ones; `done` runs after its commit.
    using Submit = std::function<void(std::function<void(Context&)> apply, Finished done)>;

    explicit Slices(Submit submit) : submit_(std::move(submit)) {}

    void seal(BatchSeal given, Done<Sealed> done) {
        run<SealedBatch>([given = std::move(given)](Context& store) { return seal_batch(store, given); }, done,
                         [this, done](SealedBatch sealed) {
                             if (!sealed.leaving) return done(std::move(sealed.answer));
                             // A batch that could not be deleted now is invisible, and is deleted later.
                             erase(*sealed.leaving, [answer = std::move(sealed.answer),
                                                     done](const std::optional<StoreFault>&) { done(answer); });
                         });
    }

    void drop(std::string batch, Done<bool> done) {
        using MaybeSeq = std::optional<std::int64_t>;
        run<MaybeSeq>([batch = std::move(batch)](Context& store) { return leave_batch(store, batch); }, done,
                      [this, done](MaybeSeq found) {
                          if (!found) return done(false);
                          erase(*found,
                                [done](const std::optional<StoreFault>& fault) { fault ? done(*fault) : done(true); });
                      });
    }

    void remove(std::string id, Done<RemoveEffect> done) {
        run<RemovedBatch>([id = std::move(id)](Context& store) { return remove_batch(store, id); }, done,
                          [this, done](RemovedBatch removed) {
                              if (removed.effect != RemoveEffect::removed) return done(removed.effect);
                              erase(removed.leaving, [done](const std::optional<StoreFault>& fault) {
                                  fault ? done(*fault) : done(RemoveEffect::removed);
                              });
                          });
    }

    void cancel(std::string id, UnixMs now, Done<std::optional<Ids>> done) {
        using MaybeSeq = std::optional<std::int64_t>;
        run<MaybeSeq>([id = std::move(id)](Context& store) { return begin_cancel(store, id); }, done,
                      [this, now, done](MaybeSeq found) {
                          if (!found) return done(std::nullopt);
                          cancel_on(*found, 0, now, [done](Outcome<Ids> ids) {
                              if (const auto* fault = std::get_if<StoreFault>(&ids)) return done(*fault);
                              done(std::optional(std::get<Ids>(std::move(ids))));
                          });
                      });
    }

    void sweep(UnixMs now, const Retention& retention, std::size_t max, Done<std::size_t> done) {
        sweep_on(now, retention, max, 0, std::move(done));
    }

    /// Continues changes that were interrupted; no caller waits for them. To be called on the thread of the callbacks,
    /// like everything that it starts.
    void go_on(const Unsettled& unsettled, UnixMs now) {
        for (const std::int64_t batch : unsettled.leaving)
            if (going_.insert(batch).second)
                erase(batch, [this, batch](const std::optional<StoreFault>&) { going_.erase(batch); });
        for (const std::int64_t batch : unsettled.cancelling)
            if (going_.insert(batch).second)
                cancel_on(batch, 0, now, [this, batch](const Outcome<Ids>&) { going_.erase(batch); });
    }

private:
    /// Passes a fault on to `done`, the value to `then`.
    template <class T, class Apply, class DoneT, class Then>
    void run(Apply apply, const DoneT& done, Then then) {
        auto value = std::make_shared<T>();
        submit_([value, apply = std::move(apply)](Context& store) { *value = apply(store); },
                [value, done, then = std::move(then)](const std::optional<StoreFault>& fault) {
                    fault ? done(*fault) : then(std::move(*value));
                });
    }

    void erase(std::int64_t batch, Finished done) {
        run<std::size_t>([batch](Context& store) { return delete_entries(store, batch, kSliceEntries); }, done,
                         [this, batch, done](std::size_t gone) { gone > 0 ? erase(batch, done) : done(std::nullopt); });
    }

    void cancel_on(std::int64_t batch, std::int64_t from, UnixMs now, Done<Ids> done) {
        using Next = std::optional<std::int64_t>;
        run<Next>([=](Context& store) { return cancel_entries(store, batch, from, now); }, done,
                  [this, batch, now, done](Next next) {
                      if (next) return cancel_on(batch, *next, now, done);
                      run<Ids>([batch](Context& store) { return end_cancel(store, batch); }, done,
                               [done](Ids ids) { done(std::move(ids)); });
                  });
    }

    void sweep_on(UnixMs now, const Retention& retention, std::size_t max, std::size_t gone, Done<std::size_t> done) {
        const auto slice = [now, retention, left = max - gone](Context& store) -> std::size_t {
            return left == 0 ? 0 : sweep_slice(store, now, retention, left);
        };
        run<std::size_t>(slice, done, [=, this](std::size_t more) {
            more > 0 ? sweep_on(now, retention, max, gone + more, done) : done(gone);
        });
    }

    Submit submit_;
    std::set<std::int64_t> going_;  ///< batches that go_on() is processing
};

}  // namespace tunewright::server
