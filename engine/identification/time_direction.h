// Times that fall from row to row: a log from the newest row to the oldest, or a clock that counts down to the end.
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
/// A file from the newest row to the oldest is turned round; a countdown becomes -9 to 0.
Record counted_down(const Record& record);

/// The model of the direction in which y follows u.
///
/// `newest_first` is that of the rows turned round, `countdown` of
/// the rows as they stand: the second where it leaves less than half of what the first leaves of y, or the first finds
/// no plant. Where neither leaves half of what the other does, both may be: then a warning (reversed-time, of level
/// bad) says so. So may they where a controller moves u (`in_loop`, as the rows turned round show it, or in
/// `countdown`): its inverse follows u in the other direction; there the rows count as turned round, as a refusal too.
Expected<IdentifiedModel> model_in_time(Expected<IdentifiedModel> newest_first, Expected<IdentifiedModel> countdown,
                                        bool in_loop);

}  // namespace tunewright
