// How much the dead time may be off by the small-gain test, whatever its sign.
#pragma once

#include "engine/loop/frequency_grid.h"

namespace tunewright {

/// The largest d such that |T(jw)| |e^(-jwd') - 1| < 1 for every w and every 0 <= d' < d: the least of
/// (2/w) asin(1/(2 |T|)) over the frequencies with |T| >= 1/2. Sufficient only: the loop may well stand more
/// (`delay_margin` is exact for later, not for earlier dead times). 0 where |T| >= 1/2 for w -> infinity (a neutral
/// loop with |L(infinity)| >= 1/3, in the limit taken analytically); infinite where |T| < 1/2 everywhere. The loop must
/// be stable. Liu and Gao (2008), Eqs. 28-29.
double small_gain_dead_time(const Loop& loop, const LoopGrid& grid);

/// sup over w of |T(jw)| |e^(-jwd) - 1|: Eq. 29 holds for this d where it is below 1. At most 1e-6 too small
/// (relative). It can be below 1 for a d beyond small_gain_dead_time, where a second peak of |T| lies at a whole turn
/// of d.
double dead_time_mismatch(const Loop& loop, const LoopGrid& grid, double d);

}  // namespace tunewright
