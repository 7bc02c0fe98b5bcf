// The design of an implemented controller: the least load IAE of its own law within the limits, computed directly
// instead of by rounding an ideal design.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/progress.h"
#include "engine/tuning/device/device_loop.h"

namespace tunewright::device {

/// The parameters that can be set: the law for a gain and two times in the controller's own form.
struct Shape {
    std::function<Law(double gain, double Ti, double Td)> law;  ///< `gain` is the size of the gain; times in the
                                                                ///< plant's unit
    bool has_integral = true, has_derivative = true;
    double sign = 1;  ///< sign of the gain
    struct Range {
        double low = 0, high = std::numeric_limits<double>::infinity();
        double within(double x) const { return std::clamp(x, low, high); }
    };
    Range gain, Ti, Td;  ///< ranges that can be set, as sizes
};

struct Settings {
    double gain = 0, Ti = 0, Td = 0;  ///< `gain` with its sign
    double load_IAE = 0;              ///< the search's own value, with an error of about 1e-4
};

/// Tighter limits: M - 1 is reduced by the share `margin`, and Mks too.
PeakLimits within(const PeakLimits& limits, double margin);

/// Searches by simplices over (Ti, Td), with the largest gain within the limits, from each of `starts`; their gains
/// only determine the frequencies of the loop. `plants`: the nominal one first, whose load IAE counts; limits hold on
/// all, to 1e-6. Errors: no_feasible_controller; cancelled.
enum class Reach {
    wide,
    near,  ///< the starts are good, from nearly the same problem: one small simplex is enough
};
Expected<Settings> search(const std::vector<const LinearPlant*>& plants, const Shape& shape, const PeakLimits& limits,
                          const std::vector<Settings>& starts, const RunControl& control, Reach reach = Reach::wide);

}  // namespace tunewright::device
