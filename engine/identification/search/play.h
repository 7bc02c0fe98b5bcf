// Backlash between u and the plant: of moves in changing directions a part is lost.
#pragma once

#include <optional>
#include <stop_token>

#include "engine/identification/fit/nuisance.h"
#include "engine/identification/fit/output_error.h"

namespace tunewright {

/// The record with its input behind the play (CleanRecord::play, v_recorded) with which the plant of `fit` explains y
/// best. The first move is assumed to find no play in its way, unless the record clearly shows that it does: a test
/// there and back does not, and the gain is then a lower bound (see play_unknowns). The shape is fitted with the play.
///
/// Empty if the record cannot show a play: at no level of u is the position another one than before, so that a gain
/// that varies with the level explains it too; u moves more often than 100 times; further inputs are recorded; or it is
/// already behind one. Also empty if it shows none of a hundredth of the range of u. Cost: about two hundred fits of
/// the shape (output_error.h) over at most 600 samples.
std::optional<CleanRecord> with_play(const CleanRecord& record, const Fit& fit, const std::stop_token& stop);

/// The width of the play, and the part of it that lies in the way of the first move: unknown, anywhere between 0 and
/// the width. No unknowns without a play.
InputUnknowns play_unknowns(const CleanRecord& record, const Fit& fit);

}  // namespace tunewright
