// A record of a loop: what shows the controller, what else moved u, and what to say where that is not enough.
#pragma once

#include <optional>
#include <string>

#include "engine/expected.h"
#include "engine/identification/closed_loop/set_point_part.h"
#include "engine/identification/identify.h"

namespace tunewright {

/// A record in which u answers y. Least squares of y on u would take the controller's answers to disturbances for the
/// plant's cause, and end between the plant and -1/C (Ljung 1999, section 13.4).
struct LoopRecord {
    ClosedLoop found;
    std::optional<SetPointPart> part;  ///< empty: nothing but feedback moves u
    double gain = 0;                   ///< of u over y in the same row, dimensionless; 0 where the law is not plain
    std::optional<double> u_rest;      ///< where the plant rests before it is moved, in the record's units
    bool moved_at_first_row = false;   ///< u left its level of rest with the first row, or before it
};

/// Samples of a loop's record that are fitted: an instrumental fit costs several times a plain one.
inline constexpr int kMaxLoopSamples = 10'000;

/// The rows of a record that are looked at for feedback, which shows from row to row: its beginning.
CleanRecord looked_at_for_feedback(const CleanRecord& record);

/// Feedback by feedback.h, by a set point whose moves u follows, or by a law over all rows (controller_law.h) that
/// leaves far less of u's variance than u leaves of y's: a quarter of what a free linear plant leaves; or half of
/// `left_by_model`, where the model of an open-loop test is known. Error: r not as long as the other columns.
Expected<std::optional<LoopRecord>> find_loop(const CleanRecord& record, const Record& as_given,
                                              std::optional<double> left_by_model = std::nullopt);

/// not_identifiable, with what shows the loop, the reason `why`, and the test to make. No step is larger than what u or
/// y have moved through in the record, nor than the actuator's range.
Error no_plant_in_loop(const CleanRecord& record, const LoopRecord& loop, const std::string& why);

}  // namespace tunewright
