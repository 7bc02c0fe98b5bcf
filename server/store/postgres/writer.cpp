#include "server/store/postgres/writer.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "server/log.h"
#include "server/store/postgres/batch_changes.h"
#include "server/store/postgres/job_changes.h"
#include "server/store/postgres/schema.h"

namespace tunewright::server::postgres {
namespace {

constexpr std::size_t kMaxGroup = 200;             // changes of a kind
constexpr std::size_t kMaxResults = 12;            // long ones: somebody may wait for the next group
constexpr std::size_t kMaxOtherChanges = 16;       // a statement each, or more
constexpr std::size_t kMaxText = 4 * 1024 * 1024;  // bytes of each kind
constexpr std::chrono::milliseconds kFirstPause{100};
constexpr std::chrono::milliseconds kMaxPause{2000};
constexpr std::chrono::seconds kMaxDoubtTime{10};
constexpr int kTriesMore = 4;  // of a group that conflicted with another, or whose connection was lost

std::size_t bytes(const Ask<NewJob, Accepted>& ask) { return ask.in.request.size(); }
std::size_t bytes(const Ask<JobEnd, bool>& ask) { return ask.in.result.size() + ask.in.error.size(); }
template <class T>
std::size_t bytes(const T&) {
    return 0;
}

/// Moves the first changes to the end of another list: at most `max`, and about kMaxText of text.
template <class T>
void move_some(std::vector<T>& from, std::vector<T>& to, std::size_t max) {
    std::size_t count = 0;
    for (std::size_t text = 0; count < std::min(max, from.size()) && text < kMaxText; count++)
        text += bytes(from[count]);
    const auto end = from.begin() + static_cast<std::ptrdiff_t>(count);
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(end));
    from.erase(from.begin(), end);
}

template <class In, class Out>
std::vector<const In*> questions(const std::vector<Ask<In, Out>>& asks) {
    std::vector<const In*> list;
    list.reserve(asks.size());
    for (const auto& ask : asks) list.push_back(&ask.in);
    return list;
}

void accept_all(Session& session, std::vector<Ask<NewJob, Accepted>>& asks, Notices& notices) {
    if (asks.empty()) return;
    std::vector<Accepted> answers = accept_jobs(session, questions(asks));
    for (std::size_t i = 0; i < asks.size(); i++) asks[i].out = std::move(answers[i]);
    notices.queued();
}

void finish_all(Session& session, std::vector<Ask<JobEnd, bool>>& asks, Notices& notices) {
    if (asks.empty()) return;
    const std::vector<bool> answers = finish_jobs(session, questions(asks));
    for (std::size_t i = 0; i < asks.size(); i++) {
        asks[i].out = answers[i];
        if (answers[i]) notices.ended(asks[i].in.id);
    }
}

void beat_all(Session& session, std::vector<Ask<Heartbeat, std::vector<Holding>>>& asks, Notices& notices) {
    for (auto& ask : asks) {
        ask.out = beat_worker(session, ask.in);
        for (const ProgressNote& note : ask.in.progress) notices.progress(note.id);
    }
}

/// Adjacent claims of one worker share a statement.
void claim_all(Session& session, std::vector<Ask<Claim, std::vector<JobRecord>>>& asks) {
    for (std::size_t first = 0; first < asks.size();) {
        Claim together = asks[first].in;
        std::size_t last = first + 1;
        const auto alike = [&](const Claim& other) {
            return other.worker == together.worker && other.lease == together.lease &&
                   other.suspects == together.suspects && other.low_first == together.low_first;
        };
        for (; last < asks.size() && alike(asks[last].in); last++) together.max += asks[last].in.max;
        std::vector<JobRecord> claimed = claim_jobs(session, together);
        for (; first < last; first++) {
            asks[first].out.clear();
            move_some(claimed, asks[first].out, asks[first].in.max);
        }
    }
}

template <class In, class Out>
void answer(std::vector<Ask<In, Out>>& asks, const std::optional<StoreFault>& fault) {
    for (auto& ask : asks) fault ? ask.done(*fault) : ask.done(std::move(ask.out));
}

void answer(Group& group, const std::optional<StoreFault>& fault) {
    answer(group.accepts, fault);
    answer(group.ends, fault);
    answer(group.beats, fault);
    for (OtherChange& change : group.others) change.done(fault);
    answer(group.claims, fault);
}

/// Calls `each` for every change, each in a group of its own.
template <class T, class Each>
void one_by_one(std::vector<T>& from, std::vector<T> Group::*place, Each each) {
    for (T& item : from) {
        Group alone;
        (alone.*place).push_back(std::move(item));
        each(alone);
    }
}

}  // namespace

std::vector<std::string> Group::requeued() const {
    std::vector<std::string> ids;
    for (const OtherChange& change : others)
        if (!change.requeued.empty()) ids.push_back(change.requeued);
    return ids;
}

Writer::Writer(Address address, std::string tag, Watch& watch)
    : address_(std::move(address)), tag_(std::move(tag)), line_(watch.line()), thread_([this] { work(); }) {}

Writer::~Writer() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
}

template <class T>
void Writer::add(std::vector<T> Group::*place, T item, bool first) {
    {
        const std::lock_guard lock(mutex_);
        std::vector<T>& list = waiting_.*place;
        list.insert(first ? list.begin() : list.end(), std::move(item));
    }
    changed_.notify_one();
}

void Writer::accept(Ask<NewJob, Accepted> ask) { add(&Group::accepts, std::move(ask)); }
void Writer::finish(Ask<JobEnd, bool> ask) {
    const bool first = ask.in.first;
    add(&Group::ends, std::move(ask), first);
}
void Writer::beat(Ask<Heartbeat, std::vector<Holding>> ask) { add(&Group::beats, std::move(ask)); }
void Writer::claim(Ask<Claim, std::vector<JobRecord>> ask) { add(&Group::claims, std::move(ask)); }
void Writer::change(OtherChange change) { add(&Group::others, std::move(change)); }

bool Writer::stopping() const {
    const std::lock_guard lock(mutex_);
    return stopping_;
}

Group Writer::next_group() {
    std::unique_lock lock(mutex_);
    const auto ready = [this] { return stopping_ || waiting_.size() > 0; };
    if (session_)
        changed_.wait(lock, ready);
    else
        changed_.wait_until(lock, next_try_, ready);
    Group group;
    // Claims and heartbeats need not wait for the disk: they run separately, between two groups that do.
    const bool quick = !waiting_.claims.empty() || !waiting_.beats.empty();
    const bool others = waiting_.size() > waiting_.claims.size() + waiting_.beats.size();
    if (quick && (!others || !std::exchange(quick_went_, true))) {
        move_some(waiting_.beats, group.beats, kMaxGroup);
        move_some(waiting_.claims, group.claims, kMaxGroup);
        return group;
    }
    quick_went_ = false;
    move_some(waiting_.ends, group.ends, kMaxResults);
    move_some(waiting_.accepts, group.accepts, kMaxGroup);
    move_some(waiting_.others, group.others, kMaxOtherChanges);
    return group;
}

void Writer::work() {
    for (;;) {
        Group group = next_group();
        if (group.size() > 0) {
            write(group);
        } else if (stopping()) {
            return;
        } else {
            healthy_ = session_ || connect();
        }
    }
}

void Writer::write(Group& group) {
    std::optional<Failure> failure = try_write(group);
    if (!failure) {
        healthy_ = true;
        return answer(group, std::nullopt);
    }
    // One change fails: each is tried alone, so that the others are not lost with it.
    const bool lost = failure->kind == Failure::Kind::broken || failure->kind == Failure::Kind::unknown;
    if (group.size() > 1 && !lost) return write_alone(group);
    if (healthy_.exchange(false) || !lost) log_error("the store cannot write: " + std::string(failure->what()));
    answer(group, failure->fault());
}

void Writer::write_alone(Group& group) {
    const auto each = [this](Group& alone) { write(alone); };
    one_by_one(group.accepts, &Group::accepts, each);
    one_by_one(group.ends, &Group::ends, each);
    one_by_one(group.beats, &Group::beats, each);
    one_by_one(group.others, &Group::others, each);
    one_by_one(group.claims, &Group::claims, each);
}

std::optional<Failure> Writer::try_write(Group& group) {
    const bool had_connection = session_ != nullptr;
    std::optional<Failure> failure = try_once(group);
    for (int again = 0; failure && again < kTriesMore; again++) {
        // A connection that was lost while idle is noticed only now; nothing of the group can have been executed.
        const bool may_do = failure->kind == Failure::Kind::conflict ||
                            (failure->kind == Failure::Kind::broken && (had_connection || session_ != nullptr));
        if (!may_do || (!session_ && !connect())) break;
        failure = try_once(group);
    }
    return failure;
}

std::optional<Failure> Writer::try_once(Group& group) {
    if (!session_ && !connect()) return Failure(Failure::Kind::broken, "there is no connection to " + address_.shown());
    const std::string life = life_;
    std::optional<std::int64_t> in_doubt;
    try {
        Notices notices;
        const std::int64_t transaction = session_->begin(group.durable());
        take_turns(*session_, questions(group.accepts), group.requeued());
        accept_all(*session_, group.accepts, notices);
        finish_all(*session_, group.ends, notices);
        beat_all(*session_, group.beats, notices);
        Work work{*session_, notices};
        for (const OtherChange& change : group.others) change.apply(work);
        claim_all(*session_, group.claims);
        in_doubt = transaction;
        session_->commit(tag_.empty() ? "" : notices.statements(tag_));
        return std::nullopt;
    } catch (const Failure& failure) {
        if (failure.kind != Failure::Kind::broken) {
            try {
                session_->rollback();
            } catch (const Failure&) {
                session_.reset();
            }
            return failure;
        }
        session_.reset();
        if (!in_doubt) return failure;
        const std::optional<bool> committed = was_committed(*in_doubt, life);
        if (committed == true) return std::nullopt;
        if (committed == false) return failure;
        return Failure(Failure::Kind::unknown,
                       "the connection was lost during a commit: " + std::string(failure.what()));
    }
}

bool Writer::connect() {
    if (Clock::now() < next_try_) return false;
    try {
        auto session = std::make_unique<Session>(address_, line_);
        life_ = server_life(*session);
        session_ = std::move(session);
        if (pause_.count() > 0) log_info("the store is connected to " + address_.shown() + " again");
        pause_ = std::chrono::milliseconds(0);
        return true;
    } catch (const Failure& failure) {
        if (pause_.count() == 0) log_error("the store has lost " + address_.shown() + ": " + failure.what());
        pause_ = std::clamp(2 * pause_, kFirstPause, kMaxPause);
        next_try_ = Clock::now() + pause_;
        return false;
    }
}

std::optional<bool> Writer::was_committed(std::int64_t transaction, const std::string& life) {
    const Clock::time_point end = Clock::now() + kMaxDoubtTime;
    while (Clock::now() < end) {
        try {
            if (session_ || connect()) {
                const pqxx::result rows = session_->run("SELECT txid_status($1)", Values().number(transaction));
                if (rows[0][0].is_null()) return std::nullopt;
                const std::string status = rows[0][0].c_str();
                const bool crashed = life_ != life;  // transactions that were in progress then are lost
                if (status == "committed") return crashed ? std::nullopt : std::optional(true);
                if (status == "aborted" || crashed) return false;
            }
        } catch (const Failure& failure) {
            if (failure.kind != Failure::Kind::broken) return std::nullopt;
            session_.reset();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return std::nullopt;
}

}  // namespace tunewright::server::postgres
