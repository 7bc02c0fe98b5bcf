// Times that decrease from row to row: a log from the newest row to the oldest, or a clock that counts down.
#pragma once

#include "engine/expected.h"
#include "engine/identification/identify.h"

namespace tunewright {

/// The record with its rows in their own order, at the times -t: those of a countdown.
///
///     t,u,y                    t,u,y
///     9,50,80                  9,20,40
///     8,50,76   newest first:  8,50,40   a countdown:
///     ...       y follows u    ...       y follows u
///     1,50,40   upwards        1,50,76   downwards
///     0,20,40                  0,50,80
///
/// For comparison: a file from the newest row to the oldest is reversed instead; a countdown becomes -9 to 0.
Record counted_down(const Record& record);

/// Chooses the model of the direction in which y follows u.
///
/// `newest_first` is the model of the reversed rows, `countdown` that of the rows in their order. `countdown` is chosen
/// if its residual is less than half of the other's, or if `newest_first` found no plant. If neither residual is less
/// than half of the other, both are possible, and a warning says so (reversed-time, of level bad). Both are also
/// possible if a controller moves u (`in_loop` in the reversed rows, or in `countdown`), because the inverse of the
/// controller follows u in the other direction; then `newest_first` is chosen, even if it is an error.
Expected<IdentifiedModel> model_in_time(Expected<IdentifiedModel> newest_first, Expected<IdentifiedModel> countdown,
                                        bool in_loop);

}  // namespace tunewright
