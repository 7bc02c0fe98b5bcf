// The contract without sockets: JSON text in, JSON text out. What the server, the command line and the tests call.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/contract/terms.h"
#include "api/json/problem.h"
#include "api/outcome.h"
#include "api/shorthand.h"
#include "engine/progress.h"

namespace tunewright::api {

struct JobRequest;
struct RangeRequest;

/// A tuning request that has been read and found valid.
struct PreparedJob {
    std::string name;  ///< "" if none
    double timeout_s = 60;
    std::string request_json;           ///< the request as sent, compact: what the store keeps and run_job takes
    std::string request_hash;           ///< of the canonical request without the terms it is run on, hexadecimal
    std::optional<Notify> notify = {};  ///< whom to tell of its end
    bool low_priority = false;
    std::optional<std::int64_t> not_before = {};  ///< its time, ms since 1970, UTC
    bool unique = false;                          ///< an earlier job of the same hash will do
    /// Decoded, for a run in this process: one of the two; both null for a batch's entry.
    std::shared_ptr<const JobRequest> request = {};
    std::shared_ptr<const RangeRequest> range = {};
};

/// A prepared request as a store keeps it, whose text is the truth for whichever process runs it.
struct StoredRequest {
    std::string_view json;  ///< PreparedJob::request_json
    std::string_view hash;  ///< PreparedJob::request_hash
};

/// What an operator allows beside the contract.
struct JobLimits {
    double default_timeout_s = 60;    ///< of a request without timeout_s
    double longest_timeout_s = 3600;  ///< at most 3600
};

/// Reads and checks a tuning request; every fault at once. 400 not JSON, 422 not a valid request.
std::variant<PreparedJob, Problem> prepare_job(std::string_view body, const JobLimits& limits = {});

/// The same for a request that has to be about a range, whatever its members are.
std::variant<PreparedJob, Problem> prepare_range(std::string_view body, const JobLimits& limits = {});

/// The same for an entry of a batch, which answers no traces unless it asks for them: evaluate.points is 0 by default,
/// and stands in the request that is kept. 422 where it has terms that only the batch as a whole can have.
std::variant<PreparedJob, Problem> prepare_entry(std::string_view body, const JobLimits& limits = {});

/// The request of a result, as a job keeps it, from the text of its file. Problems: those of prepare_job(); 422 where
/// the result names another.
std::variant<std::string, Problem> request_of_result(std::string_view result, const std::string& request);

/// Runs a prepared request to its end. Never throws for anything in the request.
JobOutcome run_job(const PreparedJob& job, const RunControl& control);
JobOutcome run_job(const StoredRequest& stored, const RunControl& control);

std::string progress_json(const Progress& progress);

Answer evaluate_call(std::string_view body, const RunControl& control);  ///< POST /v1/evaluate
Answer design_call(std::string_view body, const RunControl& control);    ///< POST /v1/design
Answer frontier_call(std::string_view body, const RunControl& control);  ///< POST /v1/frontier
Answer identify_call(std::string_view body, const RunControl& control);  ///< POST /v1/identify

/// POST /v1/records/preview: of JSON, and of the file itself, in any encoding.
Answer preview_call(std::string_view body);
Answer preview_file(std::string_view bytes);

/// The same for a CSV file as it is, in any encoding, without a request around it.
Answer identify_csv(std::string csv, const CsvRequest& question, const RunControl& control);
Answer parse_plant_call(std::string_view body);                       ///< POST /v1/plants/parse
Answer relay_call(std::string_view body, const RunControl& control);  ///< POST /v1/experiments/relay

}  // namespace tunewright::api
