// An implemented loop, continuous or sampled, with one interface for a search over its settings.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "engine/controller/sampled/sampled_pid.h"
#include "engine/loop/sampled/held_plant.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/tuning/limits.h"

namespace tunewright::device {

struct PeakLimits {
    double Ms = limits::kDefaultMs, Mt = limits::kDefaultMt;  ///< > 1
    std::optional<double> Mks;                                ///< limit on max |C S|
};

/// A controller with its program's rules; with `Ts` = 0 it is the continuous law of the gains.
using Law = SampledPid;

/// One plant with the controller's hold, or without one if Ts is 0.
class DevicePlant {
public:
    /// `plant` must outlive this object.
    DevicePlant(const LinearPlant& plant, double Ts, double computation_delay);

    const LinearPlant& plant() const { return *plant_; }
    std::complex<double> at(double omega) const;
    double highest_frequency() const;  ///< pi/Ts; infinite without sampling

private:
    const LinearPlant* plant_;
    double Ts_;
    std::optional<HeldPlant> held_;
};

/// C at omega, by the law's sampled or continuous formula.
std::complex<double> response_of(const Law& law, double omega);

/// The frequencies at which the loop is evaluated: from far below to far above its corners, or up to pi/Ts.
std::vector<double> frequencies_of(const LinearPlant& plant, const Law& law);

bool is_stable(const LinearPlant& plant, const Law& law);

/// max |S|, |T| and |C S| of a stable loop, each to 1e-8.
struct PeakValues {
    double Ms = 0, Mt = 0, Mks = 0;
    /// The largest relative excess over a limit; <= 0: all hold.
    double excess(const PeakLimits& limits) const;
};
PeakValues peaks_of(const LinearPlant& plant, const Law& law);

/// The integral of |y| after a unit load step; infinite if the loop does not settle.
double load_iae_of(const LinearPlant& plant, const Law& law);

}  // namespace tunewright::device
