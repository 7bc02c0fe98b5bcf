// Moves of u whose times the rows do not show: each is estimated within its row, together with the model, or their
// uncertainty is added to that of the dead time.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "engine/identification/fit/nuisance.h"
#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// A change of u that a row shows may have happened at any time since the previous row, because a relay, a duty cycle
/// or a person acts between two rows of the logger. Returns the record with each change at its likeliest time within
/// its row, and `v_open`, the length of that row. moved_within: the time by which all changes may be shifted together
/// without leaving their rows, beyond the uncertainty of the mean of independent times.
///
/// Minimises sse + variance sum_j ((t_j - c_j)/s_j)^2 over shape, linear coefficients and times t_j: a change is
/// equally likely anywhere in its row, of middle c_j and length sqrt(12) s_j, which counts as a normal distribution of
/// the same variance (random effects: Searle, Casella and McCulloch 1992, section 7.4). Levenberg-Marquardt, with exact
/// sensitivities to the times, from the best of the recorded times, the middles of the rows and `times`, those of the
/// fit `start`. `noise`: y's standard deviation from sample to sample, dimensionless. It is tried if the residual of
/// `start` shows shifts, or if `pattern` is set: the residual is so large that its slopes may not show them.
///
/// Empty if the times lower the residual's innovations by no more than their own freedom explains (the Laplace
/// approximations of the marginal likelihoods differ by less than 5); for fewer than two such changes, because the dead
/// time includes the delay of a single one; and for so many that the sums would take seconds. Changes after more than
/// four missing rows, or that were placed elsewhere than at a row, keep their times.
std::optional<CleanRecord> with_move_times(const CleanRecord& record, const std::vector<double>& times,
                                           const Fit& start, double noise, bool pattern, const std::stop_token& stop);

/// The estimated times; what is known of each is the row in which it lies. No unknowns if all times are known.
InputUnknowns time_unknowns(const CleanRecord& record, const Fit& fit);

/// The record with each change of u midway between the row that shows it and the row before: for a logger that writes
/// at uneven times and shows changes late. Sets RecordFacts::moved_between_rows; moves at the first row stay.
CleanRecord changed_between_rows(CleanRecord record);

/// If u moves at an arbitrary time and the next row shows it, up to a row late, the dead time of `fit` is too short by
/// as much. Returns the length of the interval around the recorded moves within which they may all lie together, for
/// RecordFacts::moved_within. It is not 0 only if a row is longer than half of the dead time (half of all lags except
/// the slowest also act as dead time). It is one row to either side: a single move is assumed to be at the row that
/// shows it, as if a program moves u and records it, but it may have been a row earlier.
///
/// 0 if y shows that each of several moves is at its row, because the recorder moved u itself. Also 0 if rows are not
/// evenly spaced or were averaged, if the times of moves have already been estimated or changed, if a move is at the
/// first row, in a gap, or within three rows of another, or if there are more than five. `fit` must be of the record's
/// samples.
double shown_within(const CleanRecord& record, const Fit& fit, const std::stop_token& stop);

}  // namespace tunewright
