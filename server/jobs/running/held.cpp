#include "server/jobs/running/held.h"

namespace tunewright::server {

void HeldJob::request(Stop why) {
    {
        const std::lock_guard lock(mutex_);
        if (reason_ == Stop::none) reason_ = why;
    }
    stop_.request_stop();
}

HeldJob::Stop HeldJob::why() const {
    const std::lock_guard lock(mutex_);
    return reason_;
}

HeldJob::Stage HeldJob::stage() const {
    const std::lock_guard lock(mutex_);
    return stage_;
}

void HeldJob::enter(Stage stage) {
    const std::lock_guard lock(mutex_);
    stage_ = stage;
}

void HeldJob::report(const Progress& progress) {
    const std::lock_guard lock(mutex_);
    progress_ = progress;
    revision_++;
}

std::optional<Progress> HeldJob::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

unsigned HeldJob::revision() const {
    const std::lock_guard lock(mutex_);
    return revision_;
}

std::shared_ptr<HeldJob> HeldJobs::add(JobRecord claimed, bool goes_first) {
    auto held = std::make_shared<HeldJob>(std::move(claimed), goes_first);
    const std::lock_guard lock(mutex_);
    std::shared_ptr<HeldJob>& place = jobs_[held->job.id];
    if (place) place->request(HeldJob::Stop::lost);
    place = held;
    return held;
}

void HeldJobs::forget(const std::shared_ptr<HeldJob>& held) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = jobs_.find(held->job.id);
        if (found == jobs_.end() || found->second != held) return;
        jobs_.erase(found);
    }
    changed_.notify_all();
}

std::shared_ptr<HeldJob> HeldJobs::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(id);
    return found == jobs_.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<HeldJob>> HeldJobs::all() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<HeldJob>> held;
    held.reserve(jobs_.size());
    for (const auto& [id, job] : jobs_) held.push_back(job);
    return held;
}

std::size_t HeldJobs::size() const {
    const std::lock_guard lock(mutex_);
    return jobs_.size();
}

bool HeldJobs::wait_until_none(std::chrono::duration<double> patience) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, patience, [this] { return jobs_.empty(); });
}

}  // namespace tunewright::server
