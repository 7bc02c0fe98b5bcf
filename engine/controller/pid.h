// Controllers: the PID law in its ideal form, with set-point weights and filters, and its other forms.
//
//   u = Kp [ (b r_f - y_f) + (1/Ti) int (r_f - y_f) dt + Td d/dt (c r_f - y_f) ],   r_f = r/(1 + s T)
//
// The nonlinear PID differs from it (b = 1, c = 0) only in the input of its integral: exp(-e^2/(2 delta_r^2)) e.
//
// Units: Kp in u per y, Ti, Td, Tf in the plant's time unit.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <variant>

#include "engine/expected.h"

namespace tunewright {

enum class FilterType {
    none,
    derivative,                ///< Td s becomes Td s/(1 + s Tf), acting on c r - y
    measurement_first_order,   ///< y_f = y/(1 + s Tf)
    measurement_second_order,  ///< y_f = y/(1 + s Tf + (s Tf)^2/2)
};

struct Filter {
    FilterType type = FilterType::none;
    double Tf = 0;  ///< > 0 unless type is none

    bool operator==(const Filter&) const = default;
};

/// Limits of u as deviations from the operating point, in units of u: min < max, min <= 0 <= max; infinite without a
/// limit.
struct ActuatorLimits {
    double min = 0;
    double max = 0;
};

/// The ideal (standard, non-interacting) form. `Ti` infinite: no integral action.
struct IdealPid {
    double Kp = 0;
    double Ti = std::numeric_limits<double>::infinity();
    double Td = 0;
    double b = 1;
    double c = 0;
    Filter filter = {};
    double setpoint_lag = 0;  ///< T of the set-point filter, >= 0; 0: none

    bool has_integral() const { return Ti < std::numeric_limits<double>::infinity(); }
    bool operator==(const IdealPid&) const = default;
};

/// Kp + Ki/s + Kd s, filter and weights as in the ideal form. Kp = 0 (pure I, I + D) is allowed.
struct ParallelPid {
    double Kp = 0;
    double Ki = 0;
    double Kd = 0;
    double b = 1;
    double c = 0;
    Filter filter = {};
    double setpoint_lag = 0;
};

/// Kp (1 + 1/(s Ti)) (1 + s Td): the interacting form. With `derivative` the filter covers the whole lead (1 + s Td)/(1
/// + s Tf).
struct SeriesPid {
    double Kp = 0;
    double Ti = 0;
    double Td = 0;
    double b = 1;
    double c = 0;
    Filter filter = {};
    double setpoint_lag = 0;
    double b_equivalent = 1;  ///< see b_equivalent(); 1 for a given series form until it is computed
};

/// u = Kp [ e + (1/Ti) int exp(-e^2/(2 delta_r^2)) e dt - Td dy/dt ], e = r - y: the integral acts little on a large
/// error. Source: Jin & Son, Studies in Informatics and Control 28 (2019) 157-166, Eqs. 3-5, with the size of the
/// set-point change held and no derivative of the set-point step.
struct Npid {
    double Kp = 0;
    double Ti = std::numeric_limits<double>::infinity();
    double Td = 0;
    std::optional<double> delta_r = {};  ///< > 0; empty: the size of the set-point step that it is evaluated with
    Filter filter = {};                  ///< none or derivative

    /// The law for small errors; all frequency-domain figures refer to it.
    IdealPid linear_part() const { return {.Kp = Kp, .Ti = Ti, .Td = Td, .filter = filter}; }
};

/// Any controller, given by the user (`baseline`, `evaluate`) or found by a method.
using Controller = std::variant<IdealPid, ParallelPid, SeriesPid, Npid>;

/// Ki = Kp/Ti, Kd = Kp Td; exact.
ParallelPid to_parallel(const IdealPid& pid);

/// Exact. Errors: Kp = 0 with Ki or Kd != 0 has no ideal form (use the parallel form itself in the loop).
Expected<IdealPid> to_ideal(const ParallelPid& pid);

/// Exact, the set-point weight included: the series form's proportional kick is Kp b, so b becomes b Kp/Kp_ideal.
/// Errors: Ti = 0; Ti + Td = Tf with a derivative filter (no proportional part is left).
Expected<IdealPid> to_ideal(const SeriesPid& pid);

/// Ti'/Ti of the ideal form, the weight that corresponds to b = 1 in the series form. 1 if no ideal form exists.
double b_equivalent(const SeriesPid& pid);

/// The ideal form of any controller; for the nonlinear PID that of its linear part. Errors: as above.
Expected<IdealPid> to_ideal(const Controller& controller);

/// The series form of the same loop, with the larger root as Ti' (SeriesPid states its law). With a derivative filter
/// it exists when (Ti + Tf)^2 >= 4 Ti (Td + Tf), else when Ti >= 4 Td; without integral action always. The error names
/// the condition that fails.
Expected<SeriesPid> to_series(const IdealPid& pid);

/// The gains of any form, as loop and simulation use them: exact, for every controller with Ti != 0. For the nonlinear
/// PID those of its linear part.
ParallelPid gains(const Controller& controller);

/// Input of the nonlinear PID's integral in place of the error e: phi(e) = exp(-e^2/(2 delta_r^2)) e. Jin & Son (2019),
/// Eqs. 3 and 5. Largest at e = delta_r; phi(e)/e lies in (0, 1].
struct ErrorScaling {
    double delta_r = 1;  ///< > 0, in units of y

    /// phi(e) - e.
    double excess(double e) const { return std::expm1(-exponent(e)) * e; }
    /// d(phi - e)/de.
    double excess_slope(double e) const {
        const double a = exponent(e);
        return std::expm1(-a) - 2 * a * std::exp(-a);
    }

    /// The describing function, the gain for a sine of this amplitude: e^-b (I0(b) - I1(b)), b = (A/(2 delta_r))^2.
    double gain_of_amplitude(double A) const;
    /// The amplitude A > 0 whose gain is k, 0 < k < 1.
    double amplitude_of_gain(double k) const;

private:
    double exponent(double e) const {
        const double x = e / delta_r;
        return 0.5 * x * x;
    }
};

}  // namespace tunewright
