// Requests for the check of loops in operation: their records, and what is known of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/contract/record.h"
#include "api/contract/terms.h"
#include "engine/controller/imc_controller.h"
#include "engine/evaluation/evaluation.h"
#include "engine/request/check/ask_check.h"

namespace tunewright::api {

inline constexpr std::size_t kMaxCheckedLoops = 2000;  ///< of one request

struct LoopRanges {
    std::optional<std::array<double, 2>> pv, op;
};

/// Facts about a loop that its record does not contain: kind, ranges, settings, weight.
struct LoopFacts {
    check::LoopKind kind = check::LoopKind::unknown;
    std::optional<bool> averaging;
    LoopRanges range;
    std::optional<Controller> controller;
    std::optional<double> weight;
};

/// One loop as sent: `record`, or `csv` with its columns.
struct GivenLoop : LoopFacts {
    std::optional<std::string> tag;
    std::optional<GivenRecord> record;
    std::optional<std::string> csv, time_unit;
    std::optional<ColumnChoices> columns;
    std::optional<std::string> start;
    std::optional<double> epoch;  ///< of `start`, s since 1970
    std::vector<std::string> notes;
};

struct CheckRequest : JobTerms {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::vector<GivenLoop> loops;
    bool cluster = true, settings = false;
};

/// The facts alone, without a record.
const Description<LoopFacts>& loop_facts_contract();

/// Gives the loop what is known of it. A kind that is not known is left as it is.
void add_facts(const LoopFacts& facts, check::LoopQuestion& question);

/// A job's request; its records are not read yet.
const Description<CheckRequest>& check_request_contract();

/// True if a request of POST /v1/jobs is a check.
bool is_check_request(const Json& request);

/// Reads the record of the loop numbered `index`.
check::LoopQuestion question_of(GivenLoop loop, const Units& units, std::size_t index);

/// The tag, or "loop 1".
std::string tag_of(const GivenLoop& loop, std::size_t index);

}  // namespace tunewright::api
