// The contract without sockets: JSON text in, JSON text out. For the server, the command line and the tests.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/contract/terms.h"
#include "api/json/problem.h"
#include "api/outcome.h"
#include "api/shorthand.h"
#include "engine/callable.h"
#include "engine/progress.h"

namespace tunewright::api {

/// The subject of a job.
enum class JobSubject { loop, range, check, structure };

/// A tuning request that has been read and found valid.
struct PreparedJob {
    std::string name;  ///< "" if none
    double timeout_s = 60;
    std::string request_json;           ///< the request as sent, compact: the store keeps it and run_job takes it
    std::string request_hash;           ///< of the canonical request without its terms, hexadecimal
    std::optional<Notify> notify = {};  ///< the webhook at its end
    bool low_priority = false;
    std::optional<std::int64_t> not_before = {};  ///< start time, ms since 1970, UTC
    bool unique = false;                          ///< an earlier job with the same hash may answer
    JobSubject subject = JobSubject::loop;
    /// Runs the decoded request in this process, given its hash; empty for an entry of a batch.
    Callable<JobOutcome(std::string_view hash, const RunControl& control)> run = {};
};

/// A prepared request as stored; any process can run it from its text.
struct StoredRequest {
    std::string_view json;  ///< PreparedJob::request_json
    std::string_view hash;  ///< PreparedJob::request_hash
};

/// Limits that an operator sets in addition to the contract.
struct JobLimits {
    double default_timeout_s = 60;    ///< for a request without timeout_s
    double longest_timeout_s = 3600;  ///< at most 3600
};

/// Reads and checks a tuning request; every fault at once. 400 not JSON, 422 not a valid request.
std::variant<PreparedJob, Problem> prepare_job(std::string_view body, const JobLimits& limits = {});

/// Reads and checks a request that must be about a range, whatever its members are.
std::variant<PreparedJob, Problem> prepare_range(std::string_view body, const JobLimits& limits = {});

/// Reads and checks a request about this structure, "cascade"; its member `structure` may be left out.
std::variant<PreparedJob, Problem> prepare_structure(std::string_view body, const std::string& structure);

/// Reads and checks an entry of a batch, which has no traces unless it asks for them: evaluate.points is 0 by default,
/// also in the stored request. 422 if it has terms that only a whole batch can have.
std::variant<PreparedJob, Problem> prepare_entry(std::string_view body, const JobLimits& limits = {});

/// Sets that default of a batch's entry: no traces. A value of the wrong type is left for the contract to refuse.
void ask_for_no_traces(nlohmann::ordered_json& request);

/// The request of a result, in its stored form, from the text of its file. Problems: those of prepare_job(); 422 if the
/// result has the hash of another request.
std::variant<std::string, Problem> request_of_result(std::string_view result, const std::string& request);

/// Runs a prepared request to its end. Never throws because of the request.
JobOutcome run_job(const PreparedJob& job, const RunControl& control);
JobOutcome run_job(const StoredRequest& stored, const RunControl& control);

std::string progress_json(const Progress& progress);

Answer evaluate_call(std::string_view body, const RunControl& control);  ///< POST /v1/evaluate
Answer design_call(std::string_view body, const RunControl& control);    ///< POST /v1/design
Answer frontier_call(std::string_view body, const RunControl& control);  ///< POST /v1/frontier
Answer identify_call(std::string_view body, const RunControl& control);  ///< POST /v1/identify

Answer controller_record_call(std::string_view body, const RunControl& control);  ///< POST /v1/records/controller

/// POST /v1/records/preview: of JSON, and of the file itself, in any encoding.
Answer preview_call(std::string_view body);
Answer preview_file(std::string_view bytes);

/// Identifies from a CSV file as it is, in any encoding, without a request around it.
Answer identify_csv(std::string csv, const CsvRequest& question, const RunControl& control);
Answer parse_plant_call(std::string_view body);                       ///< POST /v1/plants/parse
Answer relay_call(std::string_view body, const RunControl& control);  ///< POST /v1/experiments/relay

}  // namespace tunewright::api
