// How far a loop is from instability: gain, phase and delay margin over all crossings, the gain at which a loop
// oscillates, and the tolerated error of the dead time.
#pragma once

#include <optional>

#include "engine/loop/frequency_loop.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// Margins of a stable loop. Infinite if no value destabilises it.
struct Margins {
    double gain_margin;      ///< smallest factor > 1 that destabilises; infinity if none
    double gain_margin_low;  ///< largest factor < 1 that destabilises; 0 if none
    double phase_margin;     ///< rad, smallest distance of arg L from -180 degrees over all |L| = 1; infinity without
                             ///< crossing
    double delay_margin;     ///< smallest extra dead time that destabilises; infinity if none; 0 if L(infinity) > 1
                             ///< without dead time
    double gain_crossover;   ///< omega of the phase margin; 0 if there is none
    double phase_crossover;  ///< omega of the gain margin (of the lower one if only that exists); 0 without crossing
};

/// From the crossings within the grid and at the loop's ends. L without the dead time must change little from point to
/// point: the grid has points of its own around corners and resonances. On a coarser grid a pair of crossings between
/// two points would be missed.
Margins find_margins(const AnyLoop& loop, const LoopGrid& grid);

/// A gain and the period at which the loop oscillates with it.
struct UltimatePoint {
    double Ku = 0;  ///< with the sign of the feedback that oscillates
    double Pu = 0;
};

/// The P gain at which the loop loses stability when it is raised (in size) from a stable one, and the period of the
/// oscillation: Ziegler and Nichols (1942). For a stable or integrating plant the sign is that of its low-frequency
/// gain. Empty if no gain destabilises, or none stabilises.
std::optional<UltimatePoint> ultimate_point(const LinearPlant& plant);

/// The largest d such that |T(jw)| |e^(-jwd') - 1| < 1 for every w and every 0 <= d' < d: the least of (2/w) asin(1/(2
/// |T|)) over the frequencies with |T| >= 1/2. The condition is only sufficient: the loop may tolerate more
/// (`delay_margin` is exact for later, not for earlier dead times). 0 where |T| >= 1/2 for w -> infinity (a neutral
/// loop with |L(infinity)| >= 1/3, in the limit taken analytically); infinite where |T| < 1/2 everywhere. The loop must
/// be stable. Liu and Gao (2008), Eqs. 28-29.
double small_gain_dead_time(const Loop& loop, const LoopGrid& grid);

/// sup over w of |T(jw)| |e^(-jwd) - 1|: Eq. 29 holds for this d if the result is below 1. At most 1e-6 too small
/// (relative). It can be below 1 for a d beyond small_gain_dead_time, where a second peak of |T| lies at a whole turn
/// of d.
double dead_time_mismatch(const Loop& loop, const LoopGrid& grid, double d);

}  // namespace tunewright
