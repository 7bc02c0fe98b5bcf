// Moves of u in a loop's record that are not feedback: by the set point, by switching the controller on, kicks of u.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/closed_loop/feedback.h"
#include "engine/identification/closed_loop/loop_parts.h"
#include "engine/identification/identify.h"
#include "engine/identification/record/held_column.h"

namespace tunewright {

/// Moves from outside the loop, expressed as the set point that would have caused them.
struct OutsideExcitation {
    LoopExcitation kind = LoopExcitation::none;
    std::vector<double> w;  ///< at the record's samples; dimensionless like y if the set point is known, else in any
                            ///< unit
    double before = 0;      ///< the same before the first sample
    bool at_first_row = false;  ///< u left its level of rest at the first row, or before it
};

/// The set point of a record, if column r is one.
struct SetPoint {
    HeldColumn column;               ///< as given
    std::vector<double> at_samples;  ///< dimensionless like y; empty: none
    std::optional<SwitchOn> on;      ///< with this set point
    bool moves = false;
    bool is_input = false;  ///< column r is u itself, or u is a straight line over it: it commands u and does not
                            ///< respond to y
};

/// Column r at the samples of `record`. One that only tracks y, as many controllers write it in manual, is no set
/// point; neither is one that equals u, of the same row or the previous one.
SetPoint set_point_of(const CleanRecord& record, const Record& as_given);

/// True if column r is u itself (SetPoint::is_input).
bool set_point_is_input(const CleanRecord& record, const Record& as_given);

/// The moves from outside that `record` may contain, the most reliable first:
/// - moves of the set point; before the row at which a controller is switched on (loop_parts.h) the set point is set to
///   the value of y there, because nothing controlled y before;
/// - the switch-on alone, with the step from y to the set point, or of unknown size if there is none;
/// - kicks of u that the controller's law does not explain (`feedback`, times as parts of the record);
/// - a start far from the final y, with u moving and y at rest in the first rows: the set point moved, or the
///   controller was switched on, at the first row or just before it.
std::vector<OutsideExcitation> outside_excitations(const CleanRecord& record, const SetPoint& set_point,
                                                   const std::vector<OutsideMove>& kicks);

}  // namespace tunewright
