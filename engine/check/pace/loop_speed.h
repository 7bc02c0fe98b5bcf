// How quick a loop is against its own dead time, from its reaction to loads: whether it is sluggish.
#pragma once

#include <optional>
#include <span>
#include <stop_token>

namespace tunewright::check {

struct LoopSpeed {
    double slow = 0.5;          ///< likelihood that the loop is slower than its dead time asks, 0 to 1
    double by_dead_time = 0.5;  ///< the same by the dead time alone
    double information = 0;     ///< how much the dead times on the grid differ in likelihood, in logarithms
    double forward = 0;         ///< share of the dead times at which the plant's gain has the right sign
    double pace = 0;       ///< crossover frequency times dead time: 0.5 by SIMC, 0.19 at four times its time constant
    double dead_time = 0;  ///< time
    double crossover_Ti = 0;  ///< crossover frequency times integral time
    int load_steps = 0;       ///< found in the record
    double resolution = 0;    ///< time of a row of the fit
};

/// `measurement` with the sign at which the plant's gain is positive; `gain` > 0 and `Ti` are the controller's. The
/// model (1 - a q)(1 - p q) dy = (1 - p q) b q^d du + C(q) e with steps of the load is fitted for each dead time d on a
/// grid, by Gauss-Newton steps with weights that outliers do not move; the likelihood of each dead time gives that of
/// the pace. Empty: the record is too short.
std::optional<LoopSpeed> loop_speed(std::span<const double> measurement, std::span<const double> output, double gain,
                                    double Ti, double step, const std::stop_token& stop);

}  // namespace tunewright::check
