// How slowly a program may step through a schedule.
#pragma once

#include <optional>

#include "engine/controller/schedule/schedule.h"
#include "engine/expected.h"
#include "engine/range/model/range_model.h"

namespace tunewright::range {

/// The longest sample time of a program with backward rules that keeps Ms within 5 % of the continuous loop's, at the
/// model's points and at the rows, with each setting in use there, on the nominal plants. Empty: none was found, or the
/// plants are known by their frequency response alone. Errors: the model's.
Expected<std::optional<double>> longest_sample_time(const RangeModel& model, const Schedule& schedule);

}  // namespace tunewright::range
