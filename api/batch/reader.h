// Reads the requests of a batch from its body while it arrives: JSON {"jobs": [...]}, NDJSON, a CSV of loops, or files
// of many recorded loops.
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

enum class BatchForm {
    json,
    ndjson,
    csv,
    files,  ///< multipart/form-data with recorded loops: parts `file`, and `loops` (known_loops.h)
};

/// The meaning of a body in CSV.
enum class BatchKind {
    tune,   ///< a line is a loop's model: loops.h
    check,  ///< records of loops in operation, to be checked: api/historian
};

/// Parameters of a call that posts a batch.
struct BatchQuestion {
    std::optional<BatchForm> form;  ///< empty: the first bytes show it
    std::string boundary = {};      ///< of the parts of BatchForm::files
    std::string name;               ///< of the batch; "" if none
    std::optional<Notify> notify;   ///< webhook that is notified of its end
    /// Returns a problem if the `notify` of the body is not allowed. Empty function: every one is allowed.
    std::function<std::optional<Problem>(const Notify& notify)> judge_notify = {};
    BatchKind kind = BatchKind::tune;
    std::optional<std::string> time_unit = {};  ///< of a check's answers, and of times in CSV whose unit is not stated
    bool settings = false;                      ///< of a check of recorded loops: look for new settings too
    LoopOptions options;                        ///< for a CSV of models; the other forms have none
    JobLimits limits;
    std::size_t longest_entry = std::size_t{8} << 20;
    std::size_t max_entries = 100'000;
};

/// A request that may become a job, or the reason why it cannot.
struct BatchEntry {
    std::string name;  ///< "" if it has none or it cannot be read
    std::variant<PreparedJob, Problem> job;
};

class BatchReader {
public:
    explicit BatchReader(BatchQuestion question);
    ~BatchReader();

    /// Reads the next bytes, cut anywhere. Entries that end in them are appended, in order. A bad entry is an entry
    /// with a problem, which names its line. A fault of the whole batch is returned, and nothing may follow: 400 for
    /// text that is not JSON; 422 for another shape, too many entries, a name that is too long, or options that no loop
    /// can have.
    std::optional<Problem> feed(std::string_view bytes, std::vector<BatchEntry>& entries);
    /// Appends the entries that are left; those of many recorded loops come in portions, and finish() has to be called
    /// again while there are more(). 422 if the batch has no entry.
    std::optional<Problem> finish(std::vector<BatchEntry>& entries);
    bool more() const;

    /// Name of the batch, from the call or from the part of the body read so far.
    const std::string& name() const { return name_; }
    /// Webhook of the batch, from the call or from the part of the body read so far.
    const std::optional<Notify>& notify() const { return question_.notify; }
    /// Findings about the files of recorded loops; after the last finish().
    std::vector<std::string> notes() const;
    /// Entries so far.
    std::size_t count() const { return count_; }

private:
    class Cutter;
    class JsonCutter;
    class NdjsonCutter;
    class LoopsCutter;
    class LoopEntries;
    class RecordedLoopsCutter;
    class RecordedFilesCutter;
    class Finder;

    static std::unique_ptr<Cutter> csv_cutter(const BatchQuestion& question);
    std::optional<Problem> judge(std::optional<Problem> found, std::vector<RawEntry> raw,
                                 std::vector<BatchEntry>& entries);
    std::optional<Problem> refuse_options() const;
    std::optional<Problem> take_notify();
    std::optional<Problem> take(std::vector<RawEntry> raw, std::vector<BatchEntry>& entries);

    BatchQuestion question_;
    std::unique_ptr<Cutter> cutter_;
    std::string name_;
    bool notify_taken_ = false;  ///< `notify` came from the body
    std::size_t count_ = 0;
};

}  // namespace tunewright::api
