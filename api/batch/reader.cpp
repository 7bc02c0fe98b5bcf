#include "api/batch/reader.h"

#include <algorithm>
#include <utility>

#include "api/batch/jobs_array.h"
#include "api/batch/known_loops.h"
#include "api/batch/multipart.h"
#include "api/batch/pieces.h"
#include "api/batch/recorded_file.h"
#include "api/contract/terms.h"
#include "api/csv/time_stamp.h"
#include "api/historian/joined_loops.h"
#include "api/historian/loop_request.h"
#include "api/historian/loops_reader.h"
#include "api/json/json.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxLoop = 64 * 1024;

bool is_white(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Name of a request that is not valid, so that its owner recognises it.
std::string name_in(const std::string& text) {
    const auto parsed = parse(text);
    const auto* value = std::get_if<Json>(&parsed);
    if (value == nullptr || !value->is_object() || !value->contains("name")) return {};
    const Json& name = (*value)["name"];
    if (!name.is_string() || name.get_ref<const std::string&>().size() > kMaxNameLength) return {};
    return name.get<std::string>();
}

}  // namespace

/// Cuts a body into requests.
class BatchReader::Cutter {
public:
    virtual ~Cutter() = default;
    virtual std::optional<Problem> feed(std::string_view bytes, std::vector<RawEntry>& entries) = 0;
    virtual std::optional<Problem> finish(std::vector<RawEntry>& entries) = 0;
    /// True if finish() has to be called again for the next entries.
    virtual bool more() const { return false; }
    /// The name given in the body.
    virtual std::string name() const { return {}; }
    /// The text of `notify` in the body.
    virtual std::string notify() const { return {}; }
    /// Findings about the body; after the last finish().
    virtual std::vector<std::string> notes() const { return {}; }
    /// False if each request states its own method, options and units.
    virtual bool takes_options() const { return false; }
};

class BatchReader::JsonCutter : public Cutter {
public:
    explicit JsonCutter(std::size_t longest) : array_(longest) {}

    std::optional<Problem> feed(std::string_view bytes, std::vector<RawEntry>& entries) override {
        return array_.feed(bytes, entries);
    }
    std::optional<Problem> finish(std::vector<RawEntry>&) override { return array_.finish(); }
    std::string name() const override { return array_.name(); }
    std::string notify() const override { return array_.notify(); }
    bool found_jobs() const { return array_.found_jobs(); }

private:
    JobsArray array_;
};

class BatchReader::NdjsonCutter : public Cutter {
public:
    explicit NdjsonCutter(std::size_t longest) : longest_(longest), lines_(Lines::Ends::newline, longest) {}

    std::optional<Problem> feed(std::string_view bytes, std::vector<RawEntry>& entries) override {
        lines_.feed(bytes, taker(entries));
        return std::nullopt;
    }
    std::optional<Problem> finish(std::vector<RawEntry>& entries) override {
        lines_.finish(taker(entries));
        return std::nullopt;
    }

private:
    Lines::Take taker(std::vector<RawEntry>& entries) const {
        return [&](long number, std::string_view text, std::size_t bytes) {
            RawEntry entry{number, std::string(text), {}, {}};
            if (bytes > longest_) entry.fault = too_long(bytes, longest_);
            if (entry.fault || !std::all_of(text.begin(), text.end(), is_white)) entries.push_back(std::move(entry));
            return true;
        };
    }

    std::size_t longest_;
    Lines lines_;
};

class BatchReader::LoopsCutter : public Cutter {
public:
    explicit LoopsCutter(const LoopOptions& options) : loops_(options), lines_(Lines::Ends::any, kMaxLoop) {}

    std::optional<Problem> feed(std::string_view bytes, std::vector<RawEntry>& entries) override {
        std::optional<Problem> problem;
        if (!checked_) problem = loops_.check_options();
        checked_ = true;
        if (!problem) lines_.feed(bytes, taker(entries, problem));
        return problem;
    }
    std::optional<Problem> finish(std::vector<RawEntry>& entries) override {
        std::optional<Problem> problem;
        lines_.finish(taker(entries, problem));
        if (!problem) loops_.finish(entries);
        return problem;
    }

    bool takes_options() const override { return true; }

private:
    Lines::Take taker(std::vector<RawEntry>& entries, std::optional<Problem>& problem) {
        return [&](long number, std::string_view text, std::size_t bytes) {
            if (bytes > kMaxLoop)
                problem = not_valid("", "Line " + std::to_string(number) +
                                            " has more than 65536 bytes; a line of a CSV of loops must be shorter.");
            else
                problem = loops_.feed(number, text, entries);
            return !problem;
        };
    }

    Loops loops_;
    Lines lines_;
    bool checked_ = false;
};

/// Recorded loops as requests.
class BatchReader::LoopEntries {
public:
    explicit LoopEntries(const BatchQuestion& question) : longest_entry_(question.longest_entry) {
        options_.time_unit_given = question.time_unit.has_value();
        if (question.time_unit) options_.time_unit = *question.time_unit;
        if (!question.name.empty()) options_.name = question.name;
        terms_ = {options_.time_unit, options_.time_unit_given, question.settings};
    }

    const LoopsOptions& options() const { return options_; }

    /// Moves loops from `next` into entries of about a megabyte together, so that a day of many loops is never in
    /// memory twice. False after the last loop.
    template <class Next>
    bool take(const Next& next, KnownLoops& known, std::vector<RawEntry>& entries) const {
        constexpr std::size_t kPortion = std::size_t{1} << 20;
        TaggedLoop loop;
        for (std::size_t bytes = 0; bytes < kPortion; bytes += entries.back().text.size()) {
            if (!next(loop)) return false;
            entries.push_back(entry_of(loop, known.of(loop.tag)));
        }
        return true;
    }

private:
    RawEntry entry_of(const TaggedLoop& loop, const KnownLoop* known) const {
        RawEntry entry{0, {}, {}, loop.tag};
        if (loop.fault) {
            entry.fault = Problem{422, "invalid-request", "The loop cannot be read", *loop.fault, {}, {}};
            return entry;
        }
        entry.text = loop_request(loop, terms_, known != nullptr ? known->members : Json::object());
        if (entry.text.size() > longest_entry_) {
            entry.fault = too_long(entry.text.size(), longest_entry_);
            entry.fault->detail += " Send a shorter time, or export fewer rows.";
            entry.text.clear();
        }
        return entry;
    }

    LoopsOptions options_;
    CheckTerms terms_;
    std::size_t longest_entry_;
};

/// Cuts records of many loops into a request for each. All of them come at the end, in portions.
class BatchReader::RecordedLoopsCutter : public Cutter {
public:
    explicit RecordedLoopsCutter(const BatchQuestion& question) : made_(question), file_(made_.options()) {}

    std::optional<Problem> feed(std::string_view bytes, std::vector<RawEntry>&) override { return file_.feed(bytes); }

    std::optional<Problem> finish(std::vector<RawEntry>& entries) override {
        if (!std::exchange(ended_, true))
            if (auto problem = file_.finish()) return problem;
        more_ = made_.take([&](TaggedLoop& loop) { return file_.loops().next(loop); }, nothing_known_, entries);
        return std::nullopt;
    }

    bool more() const override { return more_; }
    bool takes_options() const override { return true; }
    std::vector<std::string> notes() const override { return file_.notes(); }

private:
    LoopEntries made_;
    RecordedFile file_;
    KnownLoops nothing_known_;
    bool ended_ = false, more_ = false;
};

/// The same for several files in the parts of a form, and a table with what is known of their loops.
class BatchReader::RecordedFilesCutter : public Cutter {
public:
    explicit RecordedFilesCutter(const BatchQuestion& question)
        : made_(question),
          joined_(seconds_per(made_.options().time_unit).value_or(0)),
          parts_(question.boundary,
                 {[this](const std::string& name, const std::string& file) { return begin(name, file); },
                  [this](std::string_view bytes) { return part(bytes); }, [this] { return end(); }}) {}

    std::optional<Problem> feed(std::string_view bytes, std::vector<RawEntry>&) override { return parts_.feed(bytes); }

    std::optional<Problem> finish(std::vector<RawEntry>& entries) override {
        if (!std::exchange(ended_, true)) {
            if (auto problem = parts_.finish()) return problem;
            if (auto problem = joined_.finish()) return problem;
        }
        more_ = made_.take([&](TaggedLoop& loop) { return joined_.next(loop); }, known_, entries);
        return std::nullopt;
    }

    bool more() const override { return more_; }
    bool takes_options() const override { return true; }
    std::vector<std::string> notes() const override {
        std::vector<std::string> out = joined_.notes();
        if (std::string unused = known_.unused_note(); !unused.empty()) out.push_back(std::move(unused));
        return out;
    }

private:
    static constexpr std::size_t kMaxTable = std::size_t{16} << 20;

    std::optional<Problem> begin(const std::string& name, const std::string& file) {
        if (name == "file") {
            LoopsOptions options = made_.options();
            options.max_numbers -= std::min(options.max_numbers, joined_.numbers());
            if (!file.empty()) options.set_file(file);
            name_ = file.empty() ? "the file" : file;
            file_.emplace(std::move(options));
        } else if (name != "loops") {
            return not_valid("/" + pointer_segment(name),
                             "The form has a part " + name +
                                 "; its parts must be file, as often as there are files, and "
                                 "loops, a table with what is known of the loops.");
        } else if (has_table_) {
            return not_valid("/loops", "The form has the part loops twice. Join the two tables.");
        }
        return std::nullopt;
    }

    std::optional<Problem> part(std::string_view bytes) {
        if (!file_) {
            if (table_.size() + bytes.size() > kMaxTable)
                return not_valid("/loops", "The table of loops has more than 16 MiB.");
            table_.append(bytes);
        } else if (!unreadable_) {
            unreadable_ = file_->feed(bytes);
        }
        return std::nullopt;
    }

    std::optional<Problem> end() {
        if (!file_) {
            has_table_ = true;
            auto known = KnownLoops::read(std::exchange(table_, {}), made_.options().time_unit);
            if (auto* problem = std::get_if<Problem>(&known)) return std::move(*problem);
            known_ = std::get<KnownLoops>(std::move(known));
            return std::nullopt;
        }
        if (!unreadable_) unreadable_ = file_->finish();
        unreadable_ ? joined_.add_unreadable(name_, *std::exchange(unreadable_, {}))
                    : joined_.add(name_, file_->loops());
        file_.reset();
        return std::nullopt;
    }

    LoopEntries made_;
    JoinedLoops joined_;
    Multipart parts_;
    std::string name_, table_;          ///< of the present part
    std::optional<RecordedFile> file_;  ///< the present part, if it is a file
    std::optional<Problem> unreadable_;
    bool has_table_ = false;
    KnownLoops known_;
    bool ended_ = false, more_ = false;
};

std::unique_ptr<BatchReader::Cutter> BatchReader::csv_cutter(const BatchQuestion& question) {
    if (question.kind == BatchKind::check) return std::make_unique<RecordedLoopsCutter>(question);
    return std::make_unique<LoopsCutter>(question.options);
}

/// Finds the form of a body: one that begins with { is {"jobs": ...} or the first of many lines.
class BatchReader::Finder : public Cutter {
public:
    explicit Finder(const BatchQuestion& question)
        : question_(question), json_(std::make_unique<JsonCutter>(question.longest_entry)) {}

    std::optional<Problem> feed(std::string_view bytes, std::vector<RawEntry>& entries) override {
        if (chosen_) return chosen_->feed(bytes, entries);
        // The decision depends on the text alone, not on how it was cut.
        const std::size_t looked = std::min(bytes.size(), kMaxHeadLength - head_.size());
        head_ += bytes.substr(0, looked);
        if (auto problem = find(bytes.substr(0, looked), entries)) return problem;
        if (looked == bytes.size()) return std::nullopt;
        if (!chosen_) chosen_ = std::move(json_);
        return chosen_->feed(bytes.substr(looked), entries);
    }

    std::optional<Problem> finish(std::vector<RawEntry>& entries) override {
        if (chosen_) return chosen_->finish(entries);
        const bool blank = std::all_of(head_.begin(), head_.end(), is_white);
        if (blank) return std::nullopt;
        if (auto problem = choose(std::make_unique<NdjsonCutter>(question_.longest_entry), entries)) return problem;
        return chosen_->finish(entries);
    }

    bool more() const override { return chosen_ && chosen_->more(); }
    std::string name() const override { return chosen_ ? chosen_->name() : std::string(); }
    std::string notify() const override { return chosen_ ? chosen_->notify() : std::string(); }
    std::vector<std::string> notes() const override { return chosen_ ? chosen_->notes() : std::vector<std::string>(); }
    bool takes_options() const override { return !chosen_ || chosen_->takes_options(); }

private:
    static constexpr std::size_t kMaxHeadLength = 64 * 1024;

    /// `fresh`: the bytes of the head that arrived last.
    std::optional<Problem> find(std::string_view fresh, std::vector<RawEntry>& entries) {
        constexpr std::string_view kMark = "\xEF\xBB\xBF";
        if (head_.size() < kMark.size() && kMark.starts_with(head_)) {
            // A byte order mark is possible: the first character is still to come.
        } else if (!first_) {
            if (first_at_ == 0 && head_.starts_with(kMark)) first_at_ = kMark.size();
            while (first_at_ < head_.size() && is_white(head_[first_at_])) ++first_at_;
            if (first_at_ < head_.size()) first_ = head_[first_at_];
        }
        if (first_ && *first_ != '{' && *first_ != '[') return choose(csv_cutter(question_), entries);
        auto problem = json_->feed(fresh, entries);
        if (json_->found_jobs() || first_ == '[') {
            chosen_ = std::move(json_);
            return problem;
        }
        if (!problem) return std::nullopt;
        return choose(std::make_unique<NdjsonCutter>(question_.longest_entry), entries);
    }

    std::optional<Problem> choose(std::unique_ptr<Cutter> cutter, std::vector<RawEntry>& entries) {
        chosen_ = std::move(cutter);
        const std::string head = std::move(head_);
        return chosen_->feed(head, entries);
    }

    BatchQuestion question_;
    std::unique_ptr<JsonCutter> json_;
    std::unique_ptr<Cutter> chosen_;
    std::string head_;
    std::size_t first_at_ = 0;
    std::optional<char> first_;  ///< the first character that is not white space
};

BatchReader::BatchReader(BatchQuestion question) : question_(std::move(question)), name_(question_.name) {
    if (!question_.form)
        cutter_ = std::make_unique<Finder>(question_);
    else if (*question_.form == BatchForm::json)
        cutter_ = std::make_unique<JsonCutter>(question_.longest_entry);
    else if (*question_.form == BatchForm::ndjson)
        cutter_ = std::make_unique<NdjsonCutter>(question_.longest_entry);
    else if (*question_.form == BatchForm::files)
        cutter_ = std::make_unique<RecordedFilesCutter>(question_);
    else
        cutter_ = csv_cutter(question_);
}

BatchReader::~BatchReader() = default;

std::optional<Problem> BatchReader::feed(std::string_view bytes, std::vector<BatchEntry>& entries) {
    std::vector<RawEntry> raw;
    auto found = cutter_->feed(bytes, raw);
    return judge(std::move(found), std::move(raw), entries);
}

std::optional<Problem> BatchReader::finish(std::vector<BatchEntry>& entries) {
    std::vector<RawEntry> raw;
    auto found = cutter_->finish(raw);
    if (auto problem = judge(std::move(found), std::move(raw), entries)) return problem;
    if (count_ == 0 && !more()) return not_valid("", "The batch has no requests; it needs at least one.");
    return std::nullopt;
}

bool BatchReader::more() const { return cutter_->more(); }

std::vector<std::string> BatchReader::notes() const { return cutter_->notes(); }

// Reports the first fault, however the bytes were cut.
std::optional<Problem> BatchReader::judge(std::optional<Problem> found, std::vector<RawEntry> raw,
                                          std::vector<BatchEntry>& entries) {
    if (auto problem = refuse_options()) return problem;
    if (auto problem = take_notify()) return problem;
    if (auto problem = take(std::move(raw), entries)) return problem;
    return found;
}

std::optional<Problem> BatchReader::refuse_options() const {
    if (cutter_->takes_options()) return std::nullopt;
    if (question_.time_unit)
        return not_valid("/units.time",
                         "units.time is a parameter for records; requests in JSON have their own units.");
    if (question_.settings)
        return not_valid("/settings", "settings is a parameter for records; requests in JSON have it as a member.");
    if (question_.options.empty()) return std::nullopt;
    const std::string& name = question_.options.front().first;
    return not_valid("/" + pointer_segment(name),
                     name + " is a parameter for a CSV of loops; requests in JSON have their own members.");
}

std::optional<Problem> BatchReader::take_notify() {
    if (notify_taken_) return std::nullopt;
    const std::string text = cutter_->notify();
    if (text.empty()) return std::nullopt;
    notify_taken_ = true;
    if (question_.notify)
        return not_valid("/notify", "notify is in the body and in the parameter notify_url. Remove one.");
    auto read = read_notify(text);
    if (auto* problem = std::get_if<Problem>(&read)) return std::move(*problem);
    question_.notify = std::get<Notify>(std::move(read));
    return question_.judge_notify ? question_.judge_notify(*question_.notify) : std::nullopt;
}

std::optional<Problem> BatchReader::take(std::vector<RawEntry> raw, std::vector<BatchEntry>& entries) {
    if (count_ + raw.size() > question_.max_entries) {
        return not_valid(
            "", "The batch has more than " + std::to_string(question_.max_entries) + " requests. Send it in parts.");
    }
    if (question_.name.empty()) name_ = cutter_->name();
    for (RawEntry& entry : raw) {
        ++count_;
        BatchEntry& made = entries.emplace_back();
        if (entry.fault) {
            made.name = entry.name.size() <= kMaxNameLength ? std::move(entry.name) : std::string();
            made.job = std::move(*entry.fault);
        } else {
            made.job = prepare_entry(entry.text, question_.limits);
        }
        if (const auto* job = std::get_if<PreparedJob>(&made.job)) {
            made.name = job->name;
            continue;
        }
        if (made.name.empty() && !entry.fault) made.name = name_in(entry.text);
        auto& problem = std::get<Problem>(made.job);
        const std::string place = entry.line > 0 ? "line " + std::to_string(entry.line) : made.name;
        problem.detail = "Request " + std::to_string(count_) + ", " + place + ": " + problem.detail;
    }
    return std::nullopt;
}

}  // namespace tunewright::api
