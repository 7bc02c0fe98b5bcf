#include "server/routes/batch_results.h"

#include <algorithm>
#include <mutex>

#include "api/batch/rows.h"
#include "server/log.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxRows = 200, kFirstRows = 20;
constexpr std::size_t kPageBytes = 512 * 1024;
constexpr std::chrono::seconds kPatience{20};  // for one job; then the row is looked at again
constexpr std::chrono::milliseconds kPause{500};

/// One answer. A page is read when the client has taken the one before; only one task of it is under way at a time.
class ResultsStream : public std::enable_shared_from_this<ResultsStream> {
public:
    ResultsStream(ResultsQuestion question, std::shared_ptr<http::BodyStream> stream, Batches& batches,
                  JobService& jobs, Timer& timer, Executor& lane)
        : question_(std::move(question)),
          stream_(std::move(stream)),
          batches_(batches),
          jobs_(jobs),
          timer_(timer),
          lane_(lane),
          next_(question_.from) {}

    void start() {
        if (question_.csv) stream_->write(api::csv_headings());
        stream_->on_room([self = shared_from_this()] { self->wanted(); });
    }

private:
    /// There is room: on the event loop, or after a wait.
    void wanted() {
        {
            const std::lock_guard lock(mutex_);
            if (busy_) {
                again_ = true;
                return;
            }
            busy_ = true;
        }
        lane_.post([self = shared_from_this()] { self->work(); });
    }

    void work() {
        bool waits = false;
        try {
            waits = page();
        } catch (const StoreError& error) {
            log_error(std::string("results of a batch are broken off: ") + error.what());
            stream_->break_off();
        }
        // What still waits stays busy: nothing else may go on before.
        if (!waits) idle();
    }

    void idle() {
        {
            const std::lock_guard lock(mutex_);
            busy_ = false;
            if (!again_) return;
            again_ = false;
        }
        wanted();
    }

    /// True where something is waited for, which goes on by itself.
    bool page() {
        if (stream_->gone()) return false;
        const std::size_t most = rows_;
        const std::vector<BatchRow> rows = batches_.rows(question_.batch, next_, most);
        std::string text;
        std::size_t taken = 0;
        for (; taken < rows.size(); ++taken) {
            if (question_.follow && !has_ended(rows[taken].status)) break;
            append(rows[taken], text);
        }
        if (taken > 0) {
            next_ = rows[taken - 1].index + 1;
            rows_ = std::clamp<std::size_t>(kPageBytes * taken / (text.size() + 1), 1, kMaxRows);
            stream_->write(std::move(text));
        }
        if (taken < rows.size()) return wait_for(rows[taken].id);
        if (rows.size() == most) return false;
        if (question_.follow && !all_came()) return jobs_.draining() ? break_off() : pause();
        stream_->end();
        return false;
    }

    bool all_came() {
        const auto batch = batches_.find(question_.batch);
        return !batch || (batch->sealed && next_ >= static_cast<std::int64_t>(batch->total));
    }

    bool wait_for(const std::string& job) {
        if (jobs_.draining()) return break_off();
        jobs_.wait(job, kPatience, [self = shared_from_this()] { self->go_on(); });
        return true;
    }

    /// The service stops and rows are missing: the client is to see that.
    bool break_off() {
        stream_->break_off();
        return false;
    }

    bool pause() {
        timer_.after(kPause, [self = shared_from_this()] { self->go_on(); });
        return true;
    }

    void go_on() {
        lane_.post([self = shared_from_this()] { self->work(); });
    }

    void append(const BatchRow& row, std::string& out) const {
        const api::ResultRow shown{row.index, row.id, row.name, to_string(row.status), row.result, row.error};
        question_.csv ? api::append_csv(shown, out) : api::append_ndjson(shown, out);
    }

    ResultsQuestion question_;
    std::shared_ptr<http::BodyStream> stream_;
    Batches& batches_;
    JobService& jobs_;
    Timer& timer_;
    Executor& lane_;

    // Of the task under way.
    std::int64_t next_;
    std::size_t rows_ = kFirstRows;

    std::mutex mutex_;
    bool busy_ = false;
    bool again_ = false;
};

}  // namespace

void send_results(ResultsQuestion question, std::shared_ptr<http::BodyStream> stream, Batches& batches,
                  JobService& jobs, Timer& timer, Executor& lane) {
    std::make_shared<ResultsStream>(std::move(question), std::move(stream), batches, jobs, timer, lane)->start();
}

}  // namespace tunewright::server
