// A record of a loop: the evidence for the controller, the other moves of u, and the error if they are not enough.
#pragma once

#include <optional>
#include <string>

#include "engine/expected.h"
#include "engine/identification/closed_loop/outside_excitation.h"
#include "engine/identification/closed_loop/set_point_part.h"
#include "engine/identification/identify.h"

namespace tunewright {

/// A record in which u responds to y. Least squares of y on u would mistake the controller's responses to disturbances
/// for causes of y, and give a result between the plant and -1/C (Ljung 1999, section 13.4).
struct LoopRecord {
    ClosedLoop found;
    SetPoint set_point;
    std::optional<SetPointPart> part;  ///< empty: only feedback moves u
    double gain = 0;                   ///< gain from y to u in the same row, dimensionless; 0 if there is no plain law
    std::optional<double> u_rest;      ///< input with which the plant is at rest before the moves, in the record's
                                       ///< units
    bool moved_at_first_row = false;   ///< u left its level of rest at the first row, or before it
};

/// The rows from which the model of a loop was identified, for whoever compares other controllers on them.
struct IdentifiedLoop {
    CleanRecord clean;
    HeldColumn set_point;      ///< empty: the record has none
    HeldColumn automatic;      ///< 1 in automatic and cascade, 0 in manual; empty: the mode is not recorded
    bool switched_on = false;  ///< a controller is switched on in the record (loop_parts.h)
};

/// `clean` and `set_point` are those of `record`.
IdentifiedLoop identified_loop(CleanRecord clean, SetPoint set_point, const Record& record);

/// Largest number of samples of a loop's record that are fitted, because an instrumental fit costs several times a
/// plain one.
inline constexpr int kMaxLoopSamples = 10'000;

/// The rows of a record that are searched for feedback: its beginning, because feedback shows from row to row.
CleanRecord looked_at_for_feedback(const CleanRecord& record);

/// Feedback by feedback.h, by a set point whose moves u follows, or by a law over all rows (recognised_law.h) that
/// leaves much less of u's variance unexplained than u leaves of y's: a quarter of the share with an unrestricted
/// linear plant; or half of `left_by_model`, if the model of an open-loop test is known. Error: r or
/// automatic not as long as the other columns.
Expected<std::optional<LoopRecord>> find_loop(const CleanRecord& record, const Record& as_given,
                                              std::optional<double> left_by_model = std::nullopt);

/// not_identifiable, with the evidence for the loop, the reason `why`, and the test to make. No recommended step is
/// larger than the range of u or y in the record, or than the actuator's range.
Error no_plant_in_loop(const CleanRecord& record, const LoopRecord& loop, const std::string& why);

}  // namespace tunewright
