// The largest gain at which a controller of given shape keeps its limits: for each frequency the limits forbid an
// interval of the gain, in closed form.
//
//   L = k G, k > 0:   |1 + k G| >= 1/Ms,   |k G| <= Mt |1 + k G|,   |k C1| <= Mks |1 + k G|
//
// Each is a quadratic in k. A gain is allowed if no frequency forbids it and the loop is stable; the result is the
// upper end of the stable gap with the largest gains. Source: Garpinger and Hägglund, Control Engineering Practice 16
// (2008) 1301-1309, section 3 (circles), solved per frequency instead of by iteration.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "engine/loop/sampled/held_plant.h"
#include "engine/tuning/device/device_loop.h"

namespace tunewright::device {

/// One plant with its stored response at the search's frequencies.
class GainLimiter {
public:
    /// `law` gives the sample time and the frequencies. The plant must outlive this object.
    GainLimiter(const LinearPlant& plant, const Law& law);

    /// The intervals of k that some frequency forbids, for a controller with response `unit` at gain 1; merged and
    /// ascending.
    struct Interval {
        double from = 0, to = 0;
        double omega = 0;  ///< frequency that determines `from`
    };
    std::vector<Interval> forbidden(const std::function<std::complex<double>(double)>& unit, const PeakLimits& limits);

    /// Closed-loop stability with the controller of the last forbidden() at this gain, whose law this is: along the
    /// frequencies of this object if it is sampled.
    bool is_stable(double gain, const Law& law) const;

private:
    std::complex<double> P(double omega) const { return held_ ? held_->at(omega) : plant_->at({0, omega}); }

    const LinearPlant* plant_;
    std::optional<HeldPlant> held_;  // behind the controller's hold
    std::vector<double> omega_;
    std::vector<std::complex<double>> P_, G_;  // G_: of the last forbidden(), at gain 1
};

/// The result for all plants together, at most `max`. `law_at(k)`: the controller at gain k. Empty: no gain is stable
/// and within the limits.
std::optional<double> largest_gain(std::vector<GainLimiter>& plants, const std::function<Law(double k)>& law_at,
                                   const PeakLimits& limits, double max = std::numeric_limits<double>::infinity());

}  // namespace tunewright::device
