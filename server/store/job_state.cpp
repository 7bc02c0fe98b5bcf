#include "server/store/job_state.h"

#include <array>

namespace tunewright::server {
namespace {

constexpr std::array kNames{
    std::pair{JobStatus::queued, std::string_view{"queued"}},
    std::pair{JobStatus::running, std::string_view{"running"}},
    std::pair{JobStatus::succeeded, std::string_view{"succeeded"}},
    std::pair{JobStatus::failed, std::string_view{"failed"}},
    std::pair{JobStatus::cancelled, std::string_view{"cancelled"}},
};

}  // namespace

std::optional<JobStatus> transition(JobStatus from, JobEvent event) {
    if (from == JobStatus::queued) {
        if (event == JobEvent::claim) return JobStatus::running;
        if (event == JobEvent::cancel) return JobStatus::cancelled;
    }
    if (from == JobStatus::running) {
        switch (event) {
            case JobEvent::succeed: return JobStatus::succeeded;
            case JobEvent::fail: return JobStatus::failed;
            case JobEvent::cancel: return JobStatus::cancelled;
            case JobEvent::release: return JobStatus::queued;
            case JobEvent::claim:
            case JobEvent::requeue: break;
        }
    }
    if (event == JobEvent::requeue && (from == JobStatus::failed || from == JobStatus::cancelled))
        return JobStatus::queued;
    return std::nullopt;
}

bool has_ended(JobStatus status) {
    return status == JobStatus::succeeded || status == JobStatus::failed || status == JobStatus::cancelled;
}

std::string_view to_string(JobStatus status) {
    for (const auto& [value, name] : kNames)
        if (value == status) return name;
    return "";
}

std::optional<JobStatus> job_status(std::string_view text) {
    for (const auto& [value, name] : kNames)
        if (name == text) return value;
    return std::nullopt;
}

}  // namespace tunewright::server
