// What a range's answer draws: curves over the range and runs across it.
#pragma once

#include "api/contract/range/range_result.h"

namespace tunewright::api {

/// Both curves over the same places, with the plant's own figures there.
RangeCurves curves_of(const RangeResult& result);

const Description<RangeCurves>& range_curves_contract();
const Description<RangePassage>& range_passage_contract();

}  // namespace tunewright::api
