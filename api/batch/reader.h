// Requests of a batch out of its body, while it arrives: JSON {"jobs": [...]}, NDJSON, or a CSV of loops.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/batch/loops.h"
#include "api/service.h"

namespace tunewright::api {

enum class BatchForm { json, ndjson, csv };

/// What a call says beside its body.
struct BatchQuestion {
    std::optional<BatchForm> form;  ///< nothing: its first bytes show it
    std::string name;               ///< of the batch; "" if none
    std::optional<Notify> notify;   ///< whom to tell of its end
    /// Whether whom the body names may be told; nothing where he may. Empty: everybody may.
    std::function<std::optional<Problem>(const Notify& notify)> judge_notify = {};
    LoopOptions options;  ///< for a CSV of loops; the other forms know none
    JobLimits limits;
    std::size_t longest_entry = std::size_t{8} << 20;
    std::size_t max_entries = 100'000;
};

/// A request that may become a job, or why it cannot.
struct BatchEntry {
    std::string name;  ///< "" if none, or not readable
    std::variant<PreparedJob, Problem> job;
};

class BatchReader {
public:
    explicit BatchReader(BatchQuestion question);
    ~BatchReader();

    /// The next bytes, cut anywhere. Entries that end in them are appended, in order. A bad entry is one of them; its
    /// problem says in which line it stands. What is wrong with the whole is returned, and nothing may follow: 400 not
    /// JSON, 422 another shape, too many entries, a name too long, options that no loop can have.
    std::optional<Problem> feed(std::string_view bytes, std::vector<BatchEntry>& entries);
    /// 422 without any entry.
    std::optional<Problem> finish(std::vector<BatchEntry>& entries);

    /// Of the batch, from the call or, so far, from its body.
    const std::string& name() const { return name_; }
    /// Whom to tell, likewise.
    const std::optional<Notify>& notify() const { return question_.notify; }
    /// Entries so far.
    std::size_t count() const { return count_; }

private:
    class Cutter;
    class JsonCutter;
    class NdjsonCutter;
    class LoopsCutter;
    class Finder;

    std::optional<Problem> judge(std::optional<Problem> found, std::vector<RawEntry> raw,
                                 std::vector<BatchEntry>& entries);
    std::optional<Problem> refuse_options() const;
    std::optional<Problem> take_notify();
    std::optional<Problem> take(std::vector<RawEntry> raw, std::vector<BatchEntry>& entries);

    BatchQuestion question_;
    std::unique_ptr<Cutter> cutter_;
    std::string name_;
    bool notify_taken_ = false;  ///< from the body
    std::size_t count_ = 0;
};

}  // namespace tunewright::api
