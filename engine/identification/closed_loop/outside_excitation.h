// Moves of u in a loop's record that are no feedback: the set point, switching the controller on, kicks of u.
#pragma once

#include <vector>

#include "engine/identification/closed_loop/feedback.h"
#include "engine/identification/identify.h"

namespace tunewright {

/// Moves from outside the loop, as the set point that would have moved u so.
struct OutsideExcitation {
    LoopExcitation kind = LoopExcitation::none;
    std::vector<double> w;  ///< at the record's samples, as y dimensionless where the set point is known, else in any
                            ///< unit
    double before = 0;      ///< the same before the first sample
    bool at_first_row = false;  ///< u left its level of rest with the first row, or before it
};

/// The set point of a record, as far as it is one.
struct SetPoint {
    std::vector<double> at_samples;  ///< dimensionless as y; empty: none
    bool moves = false;
    bool is_input = false;  ///< column r is u itself, or u is a straight line over it: it commands u and answers no y
};

/// Column r at the samples of `record`. One that only tracks y, as many controllers write it in manual, is none; nor is
/// one that is u, of the same row or the one before.
SetPoint set_point_of(const CleanRecord& record, const Record& as_given);

/// True if column r is u itself (SetPoint::is_input).
bool set_point_is_input(const CleanRecord& record, const Record& as_given);

/// The moves from outside that `record` may hold, the most trusted first:
/// - moves of the set point; before the row at which a controller is switched on (loop_parts.h) the set point counts as
///   what y is there, for so far nothing pulled y away;
/// - the switch-on alone, with the step from y to the set point, or of unknown size where none is known;
/// - kicks of u that the controller's law does not explain (`feedback`, times as parts of the record);
/// - a start away from where y ends, where u moves and y is at rest in the first rows: the set point moved, or the
/// controller was
///   switched on, with the first row or just before it.
std::vector<OutsideExcitation> outside_excitations(const CleanRecord& record, const SetPoint& set_point,
                                                   const std::vector<OutsideMove>& kicks);

}  // namespace tunewright
