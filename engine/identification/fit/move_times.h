// Moves of u whose times the rows do not show: each is estimated within its row, together with the model, or what they
// leave of the dead time is open.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// Changes of u that come with a row may have happened at any time since the row before: a relay, a duty or a person
/// acts between two rows of the logger. The record with each change at its likeliest time within its row, and
/// `v_open`, the length of that row; moved_within is what all changes may be moved together without one leaving its
/// row, beyond what as many independent times leave open of their mean.
///
/// Minimises sse + variance sum_j ((t_j - c_j)/s_j)^2 over shape, linear coefficients and times t_j: a change is as
/// likely anywhere in its row, of middle c_j and length sqrt(12) s_j, which counts as a normal distribution of the same
/// variance (random effects: Searle, Casella and McCulloch 1992, section 7.4). Levenberg-Marquardt, with exact
/// sensitivities to the times, from the best of the recorded times, the middles of the rows and `times`, those that
/// `start` was fitted with. `noise`: y's standard deviation from sample to sample, dimensionless. Looked for where the
/// residual of `start` shows shifts, or `pattern`: where it is so large that its own slopes may not tell.
///
/// Empty where the times lower the residual's innovations by no more than their own freedom explains (Laplace's
/// approximation of the marginal likelihoods apart by 5); for fewer than two such changes, of which the dead time takes
/// up the lateness, and for so many that the sums would take seconds. Changes that come after more than four missing
/// rows, or that were put elsewhere than at a row, keep their times.
std::optional<CleanRecord> with_move_times(const CleanRecord& record, const std::vector<double>& times,
                                           const Fit& start, double noise, bool pattern, const std::stop_token& stop);

/// Takes what the estimated times may explain out of the columns of `fit.J`, and fills `fit.nuisance`: what is left
/// determines the parameters. Rows for what is known of the times follow those of J. Does nothing where all times are
/// known.
void take_out_move_times(const CleanRecord& record, Fit& fit);

/// The record with each change of u midway between the row that shows it and the row before: what a logger that writes
/// now and then, at uneven times, has seen late. RecordFacts::moved_between_rows is then set; moves with the first row
/// stay.
CleanRecord changed_between_rows(CleanRecord record);

/// Somebody moves u at any instant, and the next row shows it: up to a row late, and the dead time of `fit` comes out
/// too short by as much. The length of time about the recorded moves within which they may all lie together, for
/// RecordFacts::moved_within, where a row is more than half of the dead time (half of the lags but the slowest act as
/// dead time too): a row to either side, as a lone move is taken to fall on the row that shows it, as where a program
/// moves u and writes it down, and may have been a row earlier.
///
/// 0 where y shows that each of several moves falls on its row: the recorder moved u itself. Also where rows are not
/// evenly spaced or were averaged, where the times of moves have been estimated or put elsewhere
/// already, and where one comes with the first row, in a gap, within three rows of another, or as the sixth. `fit` is
/// of the record's samples.
double shown_within(const CleanRecord& record, const Fit& fit, const std::stop_token& stop);

}  // namespace tunewright
