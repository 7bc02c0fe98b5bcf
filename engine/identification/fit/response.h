// The free response of a model of unit gain to a piecewise constant input, exact at any sample times.
#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

enum class Structure {
    fopdt,        ///< e^(-Ls)/(T s + 1)
    unstable,     ///< e^(-Ls)/(1 - T s): an fopdt with a negative time constant
    sopdt,        ///< e^(-Ls)/(a2 s^2 + a1 s + 1): two lags or an oscillation
    sopdt_zero,   ///< (b s + 1) e^(-Ls)/(a2 s^2 + a1 s + 1); b is linear, not a shape parameter
    ipdt,         ///< e^(-Ls)/s
    ipdt_lag,     ///< e^(-Ls)/(s (T s + 1))
    third,        ///< e^(-Ls)/((T3 s + 1)(a2 s^2 + a1 s + 1))
    ipdt_second,  ///< e^(-Ls)/(s (a2 s^2 + a1 s + 1))
};

/// The nonlinear parameters of the response, dimensionless: [L], then ln T, or ln a1 and ln rho with rho = a2/a1^2. Two
/// equal lags have rho = 1/4, an oscillation a larger rho, and rho -> 0 is one lag, so that the structures are nested
/// smoothly. Then the time at which an unmeasured load reaches the plant, if one is fitted, and ln T3; then L and ln T
/// of each further input.
struct ModelShape {
    Structure structure = Structure::fopdt;
    std::array<double, 5 + 2 * kMaxFurtherInputs> p{};

    double L() const { return p[0]; }
    double load_time() const { return p[3]; }
    double T() const;   ///< for fopdt, unstable (its magnitude), ipdt_lag
    double a1() const;  ///< for sopdt, sopdt_zero, third, ipdt_second
    double a2() const;
    double T3() const;           ///< third
    double slowest_lag() const;  ///< for self-regulating structures; for an oscillation its T
};

/// Indices in ModelShape::p that belong to a structure, that of the dead time first.
std::vector<int> shape_places(Structure structure);
/// Number of these indices, 1 to 4.
int shape_size(Structure structure);
bool is_integrating(Structure structure);
/// True if the denominator has a quadratic factor: a1 and a2 are used.
bool has_quadratic(Structure structure);
/// Its name: "fopdt", ...; "unstable fopdt" for that variant
const char* name_of(Structure structure);

inline constexpr int kLoadTime = 3, kThirdLag = 4;  ///< their indices in ModelShape::p

/// The indices in ModelShape::p of the dead time and the lag of further input `k`, from 0.
constexpr int further_dead_time(int k) { return kThirdLag + 1 + 2 * k; }
constexpr int further_lag(int k) { return further_dead_time(k) + 1; }
/// True if this index holds a time itself, not a logarithm.
constexpr bool is_time(int place) {
    return place == 0 || place == kLoadTime || (place > kThirdLag && (place - kThirdLag) % 2 == 1);
}

/// Shape of the effect of further input `k` on y, with unit gain: e^(-Ls)/(T s + 1), times 1/s if the structure
/// integrates.
ModelShape further_shape(const ModelShape& shape, int k);

/// x(t_i), dx/dt and d2x/dt2 (from the right) of the unit-gain response without zero; one entry for each sample time.
struct UnitResponse {
    std::vector<double> x, x1, x2;
};

/// e^(-Ls) over the structure's denominator: the transfer function of `unit_response`.
std::complex<double> unit_transfer(const ModelShape& shape, std::complex<double> s);

/// A piecewise constant input: 0 at first, level[j] from time[j] on; times are strictly ascending from 0.
struct InputSteps {
    std::span<const double> time, level;
};

/// Rest before t = 0. Each interval between samples and delayed changes of v is one step with the exact
/// exponential, so irregular times and dead times between samples cost no accuracy. Work: samples + changes. Only
/// derivatives up to `derivatives` (0 to 2) are filled.
void unit_response(std::span<const double> t, const InputSteps& input, const ModelShape& shape, int derivatives,
                   UnitResponse& response);

}  // namespace tunewright
