// The plants that records are made from: ten families, exact over a fixed step.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <deque>
#include <vector>

#include "engine/plant/plant.h"
#include "tests/records/random.h"

namespace tunewright::records {

enum class Family {
    equal_lags,
    spread_lags,  ///< one dominant lag, or one with three to six equal ones
    oscillating,
    inverse_response,
    integrating,
    drifting,         ///< one or two lags, with a drift of y
    sticky_valve,     ///< a dead band and stiction before the lags
    coarse_sensor,    ///< a sensor's lag and its resolution
    switched_heater,  ///< u is a duty ratio with which the element is switched
    two_time_scales,  ///< a fast part and a slow one in parallel
};
inline constexpr int kFamilies = 10;
const char* name_of(Family family);

/// K (b s + 1) e^(-Ls) / (lags, one oscillation, one integrator). Time in seconds; K is a slope if it integrates.
struct TruePlant {
    Family family = Family::equal_lags;
    double K = 1, L = 0, b = 0;
    std::vector<double> lags;
    double T_osc = 0, zeta = 1;  ///< no oscillation if T_osc is 0
    bool integrating = false;
    double drift = 0;       ///< of y over the settling time of the plant, relative to the effect of a unit of u
    double dead_band = 0;   ///< of the valve, relative to the test's amplitude
    double grid = 0;        ///< of y, relative to the effect of the test
    int switched_rows = 0;  ///< period of the switching, in rows

    double lag_sum() const;
    double settling() const;  ///< approximate settling time of a step response
    std::complex<double> response(double omega) const;
    Zpk zpk() const;
};

TruePlant make_plant(Family family, Random& random);

/// The plant simulated at a fixed step, from rest. Its dead time is rounded to whole steps.
class RunningPlant {
public:
    RunningPlant(const TruePlant& plant, double step);
    /// Advances one step under `u` and `load`, which enters behind the dead time; returns y at its end.
    double advance(double u, double load);

private:
    Eigen::MatrixXd A_;
    Eigen::VectorXd B_, C_, x_;
    std::deque<double> delayed_;
};

inline constexpr int kFine = 6;  ///< steps of the simulation per row

double on_grid(double y, double grid);  ///< y itself if grid is 0

/// The plant with its actuator: a valve that follows u only by jumps larger than its dead band, or an element that is
/// switched on and off.
class ActuatedPlant {
public:
    ActuatedPlant(const TruePlant& plant, double dt);
    /// Advances by dt/kFine; returns y at the end.
    double advance(double u, double load);
    double y() const { return y_; }

private:
    RunningPlant plant_;
    double dead_band_, valve_ = 0, y_ = 0;
    int period_, steps_ = 0;
};

}  // namespace tunewright::records
