#include "server/routes/batch_results.h"

#include <algorithm>
#include <thread>

#include "api/batch/rows.h"
#include "server/jobs/await.h"
#include "server/log.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxRows = 200, kFirstRows = 20;
constexpr std::size_t kPageBytes = 512 * 1024;
constexpr std::chrono::seconds kPatience{10};  // for one job; then the client and the row are looked at again
constexpr std::chrono::milliseconds kPause{500};

/// One answer.
class Results {
public:
    Results(ResultsQuestion question, Batches& batches, JobService& jobs, http::BodyWriter& out)
        : question_(std::move(question)), batches_(batches), jobs_(jobs), out_(out), next_(question_.from) {}

    bool send(Executor& lane) {
        if (question_.csv && !out_.write(api::csv_headings())) return false;
        for (;;) {
            std::string text;
            Next next = Next::broken;
            lane.run([&] { next = page(text); });
            if (!out_.write(text) || next == Next::broken) return false;
            if (next == Next::end) return true;
            if (next == Next::wait && !wait()) return false;
        }
    }

private:
    enum class Next { page, wait, end, broken };

    Next page(std::string& text) {
        try {
            return read_page(text);
        } catch (const StoreError& error) {
            log_error(std::string("results of a batch are broken off: ") + error.what());
            return Next::broken;
        }
    }

    Next read_page(std::string& text) {
        const std::size_t most = rows_;
        const std::vector<BatchRow> rows = batches_.rows(question_.batch, next_, most);
        std::size_t taken = 0;
        for (; taken < rows.size(); ++taken) {
            if (question_.follow && !has_ended(rows[taken].status)) break;
            append(rows[taken], text);
        }
        if (taken > 0) {
            next_ = rows[taken - 1].index + 1;
            rows_ = std::clamp<std::size_t>(kPageBytes * taken / (text.size() + 1), 1, kMaxRows);
        }
        awaited_ = taken < rows.size() ? rows[taken].id : "";
        if (taken < rows.size()) return Next::wait;
        if (rows.size() == most) return Next::page;
        return question_.follow && !all_came() ? Next::wait : Next::end;
    }

    bool all_came() {
        const auto batch = batches_.find(question_.batch);
        return !batch || (batch->sealed && next_ >= static_cast<std::int64_t>(batch->total));
    }

    /// For the job before whose row nothing may be sent, or for entries that have not come. False where the client has
    /// gone, or the service stops and rows are missing: the client is to see that.
    bool wait() {
        if (jobs_.draining() || out_.gone()) return false;
        if (awaited_.empty())
            std::this_thread::sleep_for(kPause);
        else
            await_end([&](const std::function<void()>& ended) {
                jobs_.wait(awaited_, kPatience, [ended](const auto&) { ended(); });
            });
        return true;
    }

    void append(const BatchRow& row, std::string& out) const {
        const api::ResultRow shown{row.index, row.id, row.name, to_string(row.status), row.result, row.error};
        question_.csv ? api::append_csv(shown, out) : api::append_ndjson(shown, out);
    }

    const ResultsQuestion question_;
    Batches& batches_;
    JobService& jobs_;
    http::BodyWriter& out_;
    std::int64_t next_;
    std::size_t rows_ = kFirstRows;
    std::string awaited_;  ///< the job that is waited for
};

}  // namespace

http::BodyProducer results_of(ResultsQuestion question, Batches& batches, JobService& jobs, Executor& lane) {
    return [question = std::move(question), &batches, &jobs, &lane](http::BodyWriter& out) {
        return Results(question, batches, jobs, out).send(lane);
    };
}

}  // namespace tunewright::server
