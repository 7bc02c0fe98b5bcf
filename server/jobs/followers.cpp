#include "server/jobs/followers.h"

#include <algorithm>

namespace tunewright::server {
namespace {

constexpr std::chrono::milliseconds kPollInterval{100};
constexpr std::chrono::hours kIdleWait{1};

std::shared_ptr<const JobView> view_of(const JobState& state) {
    auto view = std::make_shared<JobView>();
    static_cast<JobSummary&>(view->job) = state;
    view->job.progress = state.progress;
    return view;
}

std::shared_ptr<const JobView> view_of(const HeldJob& held) {
    auto view = std::make_shared<JobView>();
    static_cast<JobSummary&>(view->job) = held.job;
    view->progress = held.progress();
    return view;
}

}  // namespace

Followers::Followers(JobArchive& archive, const HeldJobs& held, StoreOutageLog& outage, std::chrono::milliseconds poll)
    : archive_(archive), held_(held), outage_(outage), poll_(poll) {
    pulse_ = std::make_unique<PeriodicThread>([this] { return beat(); });
}

Followers::Key Followers::follow(const std::string& id, Listener listener) {
    Key key = 0;
    bool taken = false;
    {
        const std::lock_guard lock(mutex_);
        key = next_++;
        taken = !closed_;
        if (taken) {
            Followed& followed = followed_[id];
            followed.due = true;
            followed.fresh.insert(key);
            followed.followers.emplace(key, listener);
            ids_.emplace(key, id);
        }
    }
    if (!taken) listener({JobNews::Kind::closing, nullptr});
    pulse_->wake();
    return key;
}

void Followers::leave(Key key) {
    const std::lock_guard lock(mutex_);
    const auto place = ids_.find(key);
    if (place == ids_.end()) return;
    const auto found = followed_.find(place->second);
    ids_.erase(place);
    if (found == followed_.end()) return;
    found->second.followers.erase(key);
    found->second.fresh.erase(key);
    if (found->second.followers.empty()) followed_.erase(found);
}

void Followers::changed(const std::string& id) {
    {
        const std::lock_guard lock(mutex_);
        if (followed_.empty()) return;
        if (id.empty()) {
            for (auto& [each, followed] : followed_) followed.due = true;
        } else {
            const auto found = followed_.find(id);
            if (found == followed_.end()) return;
            found->second.due = true;
        }
    }
    pulse_->wake();
}

void Followers::close() {
    std::map<std::string, Followed> left;
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        left.swap(followed_);
        ids_.clear();
    }
    for (const auto& [id, followed] : left)
        for (const auto& [key, listener] : followed.followers) listener({JobNews::Kind::closing, nullptr});
    pulse_->stop();
}

std::size_t Followers::count() const {
    const std::lock_guard lock(mutex_);
    return ids_.size();
}

std::chrono::milliseconds Followers::beat() {
    std::vector<Message> messages;
    std::vector<std::string> elsewhere;
    look_here(messages, elsewhere);
    try {
        if (!elsewhere.empty()) look_elsewhere(elsewhere, messages);
    } catch (const StoreError& error) {
        outage_.failed("it cannot be read", {error.kind, error.what()});
    }
    for (const Message& message : messages) message.listener(message.news);
    const std::lock_guard lock(mutex_);
    return followed_.empty() ? std::chrono::milliseconds(kIdleWait) : std::min(kPollInterval, poll_);
}

void Followers::look_here(std::vector<Message>& messages, std::vector<std::string>& elsewhere) {
    const auto now = Clock::now();
    const bool poll = now >= next_poll_;
    if (poll) next_poll_ = now + poll_;
    const std::lock_guard lock(mutex_);
    for (auto& [id, followed] : followed_) {
        const std::shared_ptr<HeldJob> held = held_.find(id);
        if (held && held->stage() == HeldJob::Stage::computing) {
            const Sight sight{JobStatus::running, held->job.attempts, held->revision(), ""};
            const bool known = sight == followed.last && followed.view;
            seen(followed, sight, known ? followed.view : view_of(*held), messages);
        } else if (poll || followed.due) {
            // Until the store has the result it still reports "running", with old progress.
            if (!held || held->stage() != HeldJob::Stage::ending) elsewhere.push_back(id);
        }
        followed.due = false;
    }
}

void Followers::look_elsewhere(const std::vector<std::string>& ids, std::vector<Message>& messages) {
    std::set<std::string> missing(ids.begin(), ids.end());
    std::vector<std::string> ended;
    {
        const std::vector<JobState> states = archive_.states(ids);
        const std::lock_guard lock(mutex_);
        for (const JobState& state : states) {
            missing.erase(state.id);
            const auto found = followed_.find(state.id);
            if (found == followed_.end()) continue;
            if (has_ended(state.status)) {
                ended.push_back(state.id);
                continue;
            }
            const Sight sight{state.status, state.attempts, 0, state.progress};
            const bool known = sight == found->second.last && found->second.view;
            seen(found->second, sight, known ? found->second.view : view_of(state), messages);
        }
    }
    for (const std::string& id : ended) {
        std::optional<JobRecord> job = archive_.find(id);
        if (job)
            last_news(id, {JobNews::Kind::ended, std::make_shared<JobView>(JobView{*std::move(job), {}})}, messages);
        else
            missing.insert(id);
    }
    for (const std::string& id : missing) last_news(id, {JobNews::Kind::gone, nullptr}, messages);
}

/// Requires the lock.
void Followers::seen(Followed& followed, const Sight& sight, std::shared_ptr<const JobView> view,
                     std::vector<Message>& messages) {
    const bool changed = sight != followed.last;
    followed.last = sight;
    followed.view = std::move(view);
    for (const auto& [key, listener] : followed.followers)
        if (changed || followed.fresh.contains(key))
            messages.push_back({listener, {JobNews::Kind::present, followed.view}});
    followed.fresh.clear();
}

void Followers::last_news(const std::string& id, const JobNews& news, std::vector<Message>& messages) {
    const std::lock_guard lock(mutex_);
    const auto found = followed_.find(id);
    if (found == followed_.end()) return;
    for (const auto& [key, listener] : found->second.followers) {
        messages.push_back({listener, news});
        ids_.erase(key);
    }
    followed_.erase(found);
}

}  // namespace tunewright::server
