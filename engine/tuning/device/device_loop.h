// A loop as it is built, continuous or sampled, seen in one way: what a search over its settings asks of it.
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
    std::optional<double> Mks;                                ///< of max |C S|
};

/// A controller with what its program adds; without `Ts` (0) it is the continuous law of the gains.
using Law = SampledPid;

/// One plant behind the controller's hold, or without one where Ts is 0.
class DevicePlant {
public:
    /// `plant` must outlive this.
    DevicePlant(const LinearPlant& plant, double Ts, double computation_delay);

    const LinearPlant& plant() const { return *plant_; }
    std::complex<double> at(double omega) const;
    double highest_frequency() const;  ///< pi/Ts; infinite without sampling

private:
    const LinearPlant* plant_;
    double Ts_;
    std::optional<HeldPlant> held_;
};

/// C at omega of the law, by its sampled or its continuous formula.
std::complex<double> response_of(const Law& law, double omega);

/// Where the loop is looked at: frequencies from far below to far above its corners, or to pi/Ts.
std::vector<double> frequencies_of(const LinearPlant& plant, const Law& law);

bool is_stable(const LinearPlant& plant, const Law& law);

/// max |S|, |T| and |C S| of a stable loop, each to 1e-8.
struct PeakValues {
    double Ms = 0, Mt = 0, Mks = 0;
    /// The largest relative excess over a limit; <= 0: all hold.
    double excess(const PeakLimits& limits) const;
};
PeakValues peaks_of(const LinearPlant& plant, const Law& law);

/// The integral of |y| after a unit load step; infinite where the loop does not settle.
double load_iae_of(const LinearPlant& plant, const Law& law);

}  // namespace tunewright::device
