// How good a record in operation is, before anything is concluded from it.
#pragma once

#include <array>
#include <optional>

#include "engine/check/loop_check.h"
#include "engine/check/samples.h"

namespace tunewright::check {

/// The code of the remark on a measurement that stands at an end of its range.
inline constexpr const char* kMeasurementAtLimit = "measurement-at-limit";

/// `samples` are those of `rows`; `y_range`: that of the transmitter, if known.
RecordQuality quality_of(const Rows& rows, const Samples& samples, const std::optional<std::array<double, 2>>& y_range);

}  // namespace tunewright::check
