// Whoever follows a job learns how it stands and then of each change until its end, wherever it runs. One thread serves
// all followers: it looks at what runs here ten times a second, and asks the store about all others at once, every
// `poll` and when a notice of a change comes. Knows no HTTP.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/progress.h"
#include "server/jobs/running/held.h"
#include "server/jobs/store_outage_log.h"
#include "server/store/archive.h"
#include "server/threads/periodic_thread.h"

namespace tunewright::server {

/// A job as it is this moment: what the store keeps, and the progress of one that runs in this process.
struct JobView {
    JobRecord job;
    std::optional<Progress> progress;  ///< of a job that runs here; that of others is in job.progress
};

struct JobNews {
    enum class Kind {
        present,  ///< how it stands, or a change of status or progress: `view` without request and result
        ended,    ///< the last: `view` is complete
        gone,     ///< the last: it has been deleted
        closing,  ///< the last: this process ends, others may go on with the job
    };
    Kind kind = Kind::present;
    std::shared_ptr<const JobView> view;  ///< nothing of gone and closing
};

class Followers {
public:
    using Key = std::uint64_t;
    /// Runs on the followers' thread: quick, and never throws. It may be called once more just after leave().
    using Listener = std::function<void(const JobNews&)>;

    /// All must outlive the followers.
    Followers(JobArchive& archive, const HeldJobs& held, StoreOutageLog& outage, std::chrono::milliseconds poll);

    /// `listener` learns how the job stands at once, then of changes, at most about ten a second.
    Key follow(const std::string& id, Listener listener);
    void leave(Key key);
    /// That job ("": any) may have changed: it is looked at now.
    void changed(const std::string& id);
    /// Every listener learns that this process ends; those that come later as well.
    void close();

    std::size_t count() const;

private:
    using Clock = std::chrono::steady_clock;
    /// What the listeners learned last, to see what has changed.
    struct Sight {
        JobStatus status = JobStatus::queued;
        int attempts = -1;
        unsigned revision = 0;  ///< of what runs here
        std::string progress;   ///< of what runs elsewhere
        bool operator==(const Sight&) const = default;
    };
    struct Followed {
        std::map<Key, Listener> followers;
        std::set<Key> fresh;  ///< who has heard nothing yet
        Sight last;
        std::shared_ptr<const JobView> view;
        bool due = true;
    };
    struct Message {
        Listener listener;
        JobNews news;
    };

    std::chrono::milliseconds beat();
    void look_here(std::vector<Message>& messages, std::vector<std::string>& elsewhere);
    void look_elsewhere(const std::vector<std::string>& ids, std::vector<Message>& messages);
    void seen(Followed& followed, const Sight& sight, std::shared_ptr<const JobView> view,
              std::vector<Message>& messages);
    void last_news(const std::string& id, const JobNews& news, std::vector<Message>& messages);

    JobArchive& archive_;
    const HeldJobs& held_;
    StoreOutageLog& outage_;
    std::chrono::milliseconds poll_;
    mutable std::mutex mutex_;
    std::map<std::string, Followed> followed_;
    std::map<Key, std::string> ids_;
    Key next_ = 1;
    bool closed_ = false;
    Clock::time_point next_poll_{};          ///< of the thread alone
    std::unique_ptr<PeriodicThread> pulse_;  ///< last: its thread uses all of the above
};

}  // namespace tunewright::server
