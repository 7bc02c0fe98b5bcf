// What a range's schedule is asked to be, or a schedule that is given.
#pragma once

#include "api/contract/range/range_request.h"

namespace tunewright::api {

const Description<ScheduleWish>& schedule_wish_contract();

range::RangeOptions options_of(const ScheduleWish& wish);
/// The rows that were given, if any.
std::vector<ScheduleRow> rows_of(const ScheduleWish& wish);

}  // namespace tunewright::api
