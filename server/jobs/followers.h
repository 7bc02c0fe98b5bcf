// Reports the current state of a job to its followers, and then each change until its end, wherever it runs. One thread
// serves all followers: it checks the jobs that run here ten times a second, and asks the store about all others
// together, every `poll` and after a notice of a change. Independent of HTTP.
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

/// A job at this moment: the stored data, and the progress if it runs in this process.
struct JobView {
    JobRecord job;
    std::optional<Progress> progress;  ///< of a job that runs here; that of others is in job.progress
};

struct JobNews {
    enum class Kind {
        present,  ///< the current state, or a change of status or progress: `view` without request and result
        ended,    ///< the last: `view` is complete
        gone,     ///< the last: the job was deleted
        closing,  ///< the last: this process ends, other processes may continue the job
    };
    Kind kind = Kind::present;
    std::shared_ptr<const JobView> view;  ///< empty for gone and closing
};

class Followers {
public:
    using Key = std::uint64_t;
    /// Runs on the followers' thread: quick, and never throws. It may be called once more just after leave().
    using Listener = std::function<void(const JobNews&)>;

    /// All must outlive the followers.
    Followers(JobArchive& archive, const HeldJobs& held, StoreOutageLog& outage, std::chrono::milliseconds poll);

    /// `listener` gets the state of the job at once, then changes, at most about ten a second.
    Key follow(const std::string& id, Listener listener);
    void leave(Key key);
    /// That job ("": any) may have changed: it is checked now.
    void changed(const std::string& id);
    /// Tells every listener that this process ends; also those that are added later.
    void close();

    std::size_t count() const;

private:
    using Clock = std::chrono::steady_clock;
    /// The state that the listeners got last, for comparison.
    struct Sight {
        JobStatus status = JobStatus::queued;
        int attempts = -1;
        unsigned revision = 0;  ///< of a job that runs here
        std::string progress;   ///< of a job that runs elsewhere
        bool operator==(const Sight&) const = default;
    };
    struct Followed {
        std::map<Key, Listener> followers;
        std::set<Key> fresh;  ///< listeners that have got nothing yet
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
    Clock::time_point next_poll_{};          ///< used by the thread only
    std::unique_ptr<PeriodicThread> pulse_;  ///< last: its thread uses all of the above
};

}  // namespace tunewright::server
