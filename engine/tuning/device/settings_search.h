// The design of a controller as it is built: the least load IAE that its own law reaches within the limits, from the
// start instead of by rounding an ideal design.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/progress.h"
#include "engine/tuning/device/device_loop.h"

namespace tunewright::device {

/// What can be set: the law of a gain and two times, in the controller's own form, whatever that makes of them.
struct Shape {
    std::function<Law(double gain, double Ti, double Td)> law;  ///< of the gain's size; times in the plant's unit
    bool has_integral = true, has_derivative = true;
    double sign = 1;  ///< of the gain
    struct Range {
        double low = 0, high = std::numeric_limits<double>::infinity();
        double within(double x) const { return std::clamp(x, low, high); }
    };
    Range gain, Ti, Td;  ///< that can be set, sizes
};

struct Settings {
    double gain = 0, Ti = 0, Td = 0;  ///< `gain` with its sign
    double load_IAE = 0;              ///< the search's own, to about 1e-4
};

/// Tighter limits: each M - 1 less by the share `margin`, Mks too.
PeakLimits within(const PeakLimits& limits, double margin);

/// By simplices over (Ti, Td), the gain at its largest within the limits, from each of `starts`, whose gains are only
/// where the loop's frequencies are chosen at. `plants`: the nominal one first, whose load IAE counts; limits hold on
/// all, to 1e-6. Errors: no_feasible_controller; cancelled.
enum class Reach {
    wide,
    near,  ///< the starts are good ones of almost the same task: one small simplex
};
Expected<Settings> search(const std::vector<const LinearPlant*>& plants, const Shape& shape, const PeakLimits& limits,
                          const std::vector<Settings>& starts, const RunControl& control, Reach reach = Reach::wide);

}  // namespace tunewright::device
