#include "server/routes/batch_results.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "api/batch/rows.h"
#include "server/jobs/await.h"
#include "server/log.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxRows = 200, kFirstRows = 20;  // the store returns fewer if they are long
constexpr std::size_t kPageBytes = 512 * 1024;
constexpr std::chrono::seconds kMaxJobWait{10};  // for one job; then the client and the row are checked again
constexpr std::chrono::milliseconds kRetryInterval{500};

/// The rows of one answer.
class Results {
public:
    Results(ResultsQuestion question, Batches& batches, JobService& jobs, http::BodyWriter& out)
        : question_(std::move(question)), batches_(batches), jobs_(jobs), out_(out), next_(question_.from) {}

    bool send(Executor& lane) {
        if (question_.csv && !out_.write(question_.of_checks ? api::check_csv_headings() : api::csv_headings()))
            return false;
        for (;;) {
            std::string text;
            Next next = Next::broken;
            lane.run([&] { next = page(text); });
            const bool taken = out_.write(text);
            out_.hold(0);
            if (!taken || next == Next::broken) return false;
            if (next == Next::end) return true;
            if (next == Next::wait && !wait()) return false;
        }
    }

private:
    enum class Next { page, wait, end, broken };

    /// Runs on the lane, which is held until there is room for the page: no other pages are made meanwhile.
    Next page(std::string& text) {
        try {
            const Next next = read_page(text);
            out_.hold(text.capacity());
            return next;
        } catch (const StoreError& error) {
            log_error(std::string("sending the results of a batch failed: ") + error.what());
            return Next::broken;
        }
    }

    Next read_page(std::string& text) {
        const std::size_t max = rows_;
        const std::vector<BatchRow> rows = batches_.rows(question_.batch, next_, max);
        std::size_t taken = 0;
        for (; taken < rows.size(); ++taken) {
            // A batch that is being deleted loses its first rows first.
            if (rows[taken].index != next_) return deleted();
            if (question_.follow && !has_ended(rows[taken].status)) break;
            append(rows[taken], text);
            next_++;
        }
        if (taken > 0) rows_ = std::clamp<std::size_t>(kPageBytes * taken / (text.size() + 1), 1, kMaxRows);
        awaited_ = taken < rows.size() ? rows[taken].id : "";
        if (taken < rows.size()) return Next::wait;
        return !rows.empty() && rows.size() == max ? Next::page : after_last(!rows.empty());
    }

    /// The store returned fewer rows than requested: they were long, or there are no more.
    Next after_last(bool some) {
        const auto batch = batches_.find(question_.batch);
        if (!batch) return deleted();
        if (next_ < static_cast<std::int64_t>(batch->total))
            // Entries may have arrived between the two reads; if the second read does not find them either, they were
            // deleted.
            return std::exchange(missed_, !some) && !some ? deleted() : Next::page;
        return question_.follow && !batch->sealed ? Next::wait : Next::end;
    }

    Next deleted() const {
        log_info("results of the batch " + question_.batch + " ended early: the batch was deleted meanwhile");
        return Next::broken;
    }

    /// Waits for the job whose row is next, or for entries that have not arrived. False if the client has disconnected,
    /// or if the service stops while rows are missing: the client must notice that.
    bool wait() {
        if (jobs_.draining() || out_.gone() || (question_.admitted && !question_.admitted())) return false;
        if (awaited_.empty())
            std::this_thread::sleep_for(kRetryInterval);
        else
            await_end([&](const std::function<void()>& ended) {
                jobs_.wait(awaited_, kMaxJobWait, [ended](const auto&) { ended(); });
            });
        return true;
    }

    void append(const BatchRow& row, std::string& out) const {
        const api::ResultRow shown{row.index, row.id, row.name, to_string(row.status), row.result, row.error};
        if (!question_.csv)
            api::append_ndjson(shown, out);
        else
            question_.of_checks ? api::append_check_csv(shown, out) : api::append_csv(shown, out);
    }

    const ResultsQuestion question_;
    Batches& batches_;
    JobService& jobs_;
    http::BodyWriter& out_;
    std::int64_t next_;
    std::size_t rows_ = kFirstRows;
    bool missed_ = false;  ///< the last read found no row although the batch has some
    std::string awaited_;  ///< the job whose end is awaited
};

}  // namespace

http::BodyProducer results_of(ResultsQuestion question, Batches& batches, JobService& jobs, Executor& lane) {
    return [question = std::move(question), &batches, &jobs, &lane](http::BodyWriter& out) {
        return Results(question, batches, jobs, out).send(lane);
    };
}

}  // namespace tunewright::server
