// libFuzzer on exported and uploaded files: CSV records, and batches as JSON, NDJSON, CSV of loops and records of many
// loops. For any bytes,
// the result is either printable sentences, or finite numbers and requests that are JSON; and a batch does not depend
// on how its bytes are cut. First byte: the reader; second: the seed of the cuts.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>

#include "api/batch/reader.h"
#include "api/contract/terms.h"
#include "api/csv/csv_record.h"
#include "api/json/json.h"
#include "api/json/utf8.h"
#include "engine/identification/record/clean_record.h"
#include "engine/identification/record/record_kind.h"
#include "engine/tuning/registry.h"

namespace tunewright::api {

// The real function reads the contract, which is not tested here.
std::variant<PreparedJob, Problem> prepare_entry(std::string_view body, const JobLimits&) {
    auto parsed = parse(body);
    if (auto* problem = std::get_if<Problem>(&parsed)) return std::move(*problem);
    return PreparedJob{"", 60, std::string(body), ""};
}

std::variant<Notify, Problem> read_notify(std::string_view json) {
    auto parsed = parse(json);
    if (auto* problem = std::get_if<Problem>(&parsed)) return std::move(*problem);
    return Notify{};
}

}  // namespace tunewright::api

namespace tunewright {
// A problem may hold rows of a record that was not identified; those of these readers hold none.
Expected<CleanRecord> clean_record(const Record&) { std::abort(); }
std::vector<double> move_times(const CleanRecord&) { std::abort(); }

// The lines of a batch name a method or use this one; the methods themselves are not tested here.
const std::string& default_method() {
    static const std::string id = "robust";
    return id;
}
}  // namespace tunewright

namespace {

using namespace tunewright::api;

void require(bool holds, const char* what, const std::string& detail = "") {
    if (holds) return;
    std::cerr << "broken promise: " << what << "\n" << detail << "\n";
    std::abort();
}

void require_readable(const Problem& problem) {
    require(!problem.detail.empty() && is_utf8(to_json(problem)), "a readable problem", problem.detail);
}

std::string shown(const std::vector<BatchEntry>& entries) {
    std::string text;
    for (const BatchEntry& entry : entries) {
        require(is_utf8(entry.name), "a readable name");
        if (const auto* job = std::get_if<PreparedJob>(&entry.job)) {
            text += job->request_json + "\n";
        } else {
            const Problem& problem = std::get<Problem>(entry.job);
            require_readable(problem);
            text += to_json(problem) + "\n";
        }
    }
    return text;
}

/// Entries before a fault of the whole batch may differ with the cuts; none of them is kept.
std::string read_batch(const BatchQuestion& question, std::string_view body, unsigned seed) {
    std::minstd_rand chance(seed);
    BatchReader reader(question);
    std::vector<BatchEntry> entries;
    std::optional<Problem> problem;
    while (!body.empty() && !problem) {
        const std::size_t piece = seed == 0 ? body.size() : 1 + chance() % (chance() % 3 == 0 ? body.size() : 8);
        problem = reader.feed(body.substr(0, piece), entries);
        body.remove_prefix(std::min(piece, body.size()));
    }
    if (!problem) problem = reader.finish(entries);
    while (!problem && reader.more()) problem = reader.finish(entries);
    if (problem) {
        require_readable(*problem);
        require(problem->status == 400 || problem->status == 422, "a refusal's status");
        return to_json(*problem);
    }
    require(is_utf8(reader.name()) && reader.count() == entries.size(), "a name and a count");
    return reader.name() + "\n" + shown(entries);
}

void read_record(std::string_view bytes) {
    CsvOptions options;
    options.max_samples = 1000;
    const auto read = read_csv_record(bytes, options);
    if (const auto* faults = std::get_if<std::vector<CsvFault>>(&read)) {
        require(!faults->empty(), "a reason");
        for (const CsvFault& fault : *faults) require(is_utf8(fault.message), "a readable fault", fault.message);
        return;
    }
    const auto& record = std::get<CsvRecord>(read);
    require(record.t.size() == record.u.size() && record.t.size() == record.y.size(), "columns of one length");
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        require(std::isfinite(record.t[i]), "finite times");
        require(!std::isinf(record.u[i]) && !std::isinf(record.y[i]), "finite values");
        require(!std::isnan(record.u[i]) || !std::isnan(record.y[i]), "a value in each sample");
    }
    for (const std::string& note : record.notes) require(is_utf8(note), "a readable note", note);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2) return 0;
    const std::string_view body(reinterpret_cast<const char*>(data) + 2, size - 2);
    BatchQuestion question;
    question.longest_entry = 300;
    question.max_entries = 50;
    switch (data[0] % 6) {  // the digits 0 to 5 stand for themselves
        case 0: break;
        case 1: question.form = BatchForm::json; break;
        case 2: question.form = BatchForm::ndjson; break;
        case 3:
            question.form = BatchForm::csv;
            question.options = {{"method", "simc"}};
            break;
        case 4: read_record(body); return 0;
        default:
            question.form = BatchForm::csv;
            question.kind = BatchKind::check;
            question.longest_entry = 4000;
    }
    const std::string whole = read_batch(question, body, 0);
    const std::string cut = read_batch(question, body, 1U + data[1]);
    require(cut == whole, "the same however it is cut", whole + "\n--- and cut ---\n" + cut);
    return 0;
}
