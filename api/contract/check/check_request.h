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

/// One loop as sent: `record`, or `csv` with its columns.
struct GivenLoop {
    std::optional<std::string> tag;
    check::LoopKind kind = check::LoopKind::unknown;
    std::optional<bool> averaging;
    std::optional<GivenRecord> record;
    std::optional<std::string> csv, time_unit;
    std::optional<ColumnChoices> columns;
    std::optional<std::string> start;
    std::optional<double> epoch;  ///< of `start`, s since 1970
    LoopRanges range;
    std::optional<Controller> controller;
    std::optional<double> weight;
};

struct CheckRequest : JobTerms {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::vector<GivenLoop> loops;
    bool cluster = true, settings = false;
};

/// A job's request; its records are not read yet.
const Description<CheckRequest>& check_request_contract();

/// True if a request of POST /v1/jobs is a check.
bool is_check_request(const Json& request);

/// Reads the record of the loop numbered `index`; a record that cannot be read gives the reason, a sentence.
OrReason<check::LoopQuestion> question_of(GivenLoop loop, const Units& units, std::size_t index);

/// The tag, or "loop 1".
std::string tag_of(const GivenLoop& loop, std::size_t index);

}  // namespace tunewright::api
