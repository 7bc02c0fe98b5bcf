// Answers about a whole operating range. They are written, never read.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/range/experiments.h"
#include "engine/request/range/ask_range.h"

namespace tunewright::api {

/// Ms, Mt and cost over the range; NaN where they are not known.
struct RangeTraces {
    std::vector<double> Ms, Mt, relative_IAE;
    std::vector<double> Kp, Ti, Td;  ///< of a schedule: the interpolated settings there
};

struct RangeCurves {
    std::vector<double> at, K, T, L, u, y;  ///< u, y for equations only
    std::optional<RangeTraces> one, schedule;
};

struct RangeWorst {
    std::vector<range::WorstPoint> one, schedule;
};

/// The result in the structure of the contract.
struct RangeContent {
    explicit RangeContent(RangeResult result);
    RangeContent() = default;

    RangeResult result;
    OrReason<range::OneSetting> one;
    OrReason<range::ScheduleDesign> schedule;
    RangeCurves curves;
    RangeWorst worst;
};

/// The result with members that only the request has.
struct RangeAnswer {
    RangeContent range;
    std::optional<Units> units;
    std::string request_hash;
};

/// The result of a job about a range.
const Description<RangeAnswer>& range_result_contract();

/// The answer of POST /v1/range.
const Description<RangeAnswer>& range_answer_contract();

const Description<RangeContent>& range_content_contract();

/// Both curves over the same places, with the plant's own figures there.
RangeCurves curves_of(const RangeResult& result);
const Description<RangeCurves>& range_curves_contract();
const Description<RangePassage>& range_passage_contract();

}  // namespace tunewright::api
