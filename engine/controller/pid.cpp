#include "engine/controller/pid.h"

#include <cmath>
#include <numbers>

#include "engine/number_text.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kDiscriminantTolerance = 1e-13;  // relative to sum^2: below it two zeros count as equal
constexpr double kMinAsymptoticArgument = 300;    // beyond it the Bessel functions' asymptote is exact enough
constexpr double kMaxAmplitude = 1e12;            // multiple of delta_r: the gain is below 1e-35 there
constexpr double kAmplitudeTolerance = 1e-13;     // of the bracket's upper end, at most twice the amplitude

// Filter time inside the lead. With `derivative` the series form's filter covers the whole lead (1 + s Td)/(1 + s Tf),
// the ideal form's only Td s; measurement filters are outside the law in both forms, as if Tf were 0 here.
double lead_filter(const Filter& filter) { return filter.type == FilterType::derivative ? filter.Tf : 0; }

// Ratio of the ideal form's Kp and Ti to the series form's; 1 without integral action.
double interaction(const SeriesPid& pid) { return 1 + (pid.Td - lead_filter(pid.filter)) / pid.Ti; }

struct Roots {
    double larger, smaller;
};

// x^2 - sum x + product = 0 without cancellation; `discriminant` = sum^2 - 4 product >= 0.
Roots real_roots(double sum, double product, double discriminant) {
    const double root = std::sqrt(discriminant);
    if (sum >= 0) {
        const double larger = (sum + root) / 2;
        return {larger, larger == 0 ? 0 : product / larger};
    }
    const double smaller = (sum - root) / 2;
    return {product / smaller, smaller};
}

Error no_series(const IdealPid& pid, double Tf) {
    std::string message = "No series form: ";
    if (Tf > 0) {
        message += "(Ti + Tf)^2 = " + text(std::pow(pid.Ti + Tf, 2)) +
                   " is below 4 Ti (Td + Tf) = " + text(4 * pid.Ti * (pid.Td + Tf)) + ", so its zeros are complex.";
    } else {
        message += "Ti = " + text(pid.Ti) + " is below 4 Td = " + text(4 * pid.Td) + ", so its zeros are complex.";
    }
    return {ErrorKind::unsupported, "", message + " Use the ideal or the parallel form."};
}

}  // namespace

ParallelPid to_parallel(const IdealPid& pid) {
    return {.Kp = pid.Kp,
            .Ki = pid.Kp / pid.Ti,
            .Kd = pid.Kp * pid.Td,
            .b = pid.b,
            .c = pid.c,
            .filter = pid.filter,
            .setpoint_lag = pid.setpoint_lag};
}

Expected<IdealPid> to_ideal(const ParallelPid& pid) {
    IdealPid ideal{.Kp = pid.Kp, .b = pid.b, .c = pid.c, .filter = pid.filter, .setpoint_lag = pid.setpoint_lag};
    if (pid.Kp == 0) {
        if (pid.Ki == 0 && pid.Kd == 0) return ideal;
        return Error{ErrorKind::unsupported, "",
                     "No ideal form: Kp is 0 while Ki = " + text(pid.Ki) + " and Kd = " + text(pid.Kd) +
                         "; Ti and Td are ratios to Kp. Keep the parallel form."};
    }
    if (pid.Ki != 0) ideal.Ti = pid.Kp / pid.Ki;
    ideal.Td = pid.Kd / pid.Kp;
    return ideal;
}

Expected<IdealPid> to_ideal(const SeriesPid& pid) {
    if (pid.Ti == 0)
        return Error{ErrorKind::invalid_argument, "Ti", "Ti is 0; it must be above 0, or null for no integral action."};
    const double Tf = lead_filter(pid.filter), factor = interaction(pid);
    if (factor == 0)
        return Error{ErrorKind::unsupported, "",
                     "No ideal form: Ti + Td = Tf = " + text(Tf) +
                         ", so no proportional part is left. Choose a shorter filter or the parallel form."};
    // Without integral action Ti stays infinite whatever the factor's sign.
    const double Ti = std::isinf(pid.Ti) ? pid.Ti : pid.Ti * factor;
    return IdealPid{.Kp = pid.Kp * factor,
                    .Ti = Ti,
                    .Td = pid.Td / factor - Tf,
                    .b = pid.b / factor,
                    .c = pid.c,
                    .filter = pid.filter,
                    .setpoint_lag = pid.setpoint_lag};
}

double b_equivalent(const SeriesPid& pid) {
    const double factor = interaction(pid);
    return factor == 0 ? 1 : 1 / factor;
}

Expected<SeriesPid> to_series(const IdealPid& pid) {
    const double Tf = lead_filter(pid.filter);
    SeriesPid series{.Kp = pid.Kp,
                     .Ti = pid.Ti,
                     .Td = pid.Td + Tf,
                     .b = pid.b,
                     .c = pid.c,
                     .filter = pid.filter,
                     .setpoint_lag = pid.setpoint_lag};
    if (!pid.has_integral()) return series;
    const double sum = pid.Ti + Tf;
    // Equals sum^2 - 4 Ti (Td + Tf), written so that Td = 0 gives a square exactly.
    double discriminant = std::pow(pid.Ti - Tf, 2) - 4 * pid.Ti * pid.Td;
    // Two equal zeros (Ti = 4 Td, as for equal lags) may give a small negative value by rounding.
    if (std::abs(discriminant) < kDiscriminantTolerance * sum * sum) discriminant = 0;
    if (!(discriminant >= 0) || pid.Ti == 0) return no_series(pid, Tf);
    const Roots roots = real_roots(sum, pid.Ti * (pid.Td + Tf), discriminant);
    series.Ti = roots.larger;
    series.Td = roots.smaller;
    series.b_equivalent = roots.larger / pid.Ti;
    series.Kp = pid.Kp * series.b_equivalent;
    return series;
}

Expected<IdealPid> to_ideal(const Controller& controller) {
    struct Conversion {
        Expected<IdealPid> operator()(const IdealPid& pid) const { return pid; }
        Expected<IdealPid> operator()(const Npid& npid) const { return npid.linear_part(); }
        Expected<IdealPid> operator()(const ParallelPid& pid) const { return to_ideal(pid); }
        Expected<IdealPid> operator()(const SeriesPid& pid) const { return to_ideal(pid); }
    };
    return std::visit(Conversion{}, controller);
}

namespace {

ParallelPid gains_of(const IdealPid& pid) { return to_parallel(pid); }
ParallelPid gains_of(const ParallelPid& pid) { return pid; }
ParallelPid gains_of(const Npid& npid) { return to_parallel(npid.linear_part()); }

ParallelPid gains_of(const SeriesPid& pid) {
    const double Tf = lead_filter(pid.filter), factor = interaction(pid);
    return {.Kp = pid.Kp * factor,
            .Ki = pid.Kp / pid.Ti,
            .Kd = pid.Kp * (pid.Td - Tf * factor),
            .b = factor == 0 ? pid.b : pid.b / factor,
            .c = pid.c,
            .filter = pid.filter,
            .setpoint_lag = pid.setpoint_lag};
}

}  // namespace

ParallelPid gains(const Controller& controller) {
    return std::visit([](const auto& pid) { return gains_of(pid); }, controller);
}

double ErrorScaling::gain_of_amplitude(double A) const {
    const double x = 0.5 * A / delta_r, b = x * x;
    // e^-b (I0 - I1) -> (1 + 3/(8 b))/(2 b sqrt(2 pi b)).
    if (b > kMinAsymptoticArgument) return (1 + 0.375 / b) / (2 * b * std::sqrt(2 * std::numbers::pi * b));
    return std::exp(-b) * (std::cyl_bessel_i(0.0, b) - std::cyl_bessel_i(1.0, b));
}

double ErrorScaling::amplitude_of_gain(double k) const {
    const auto surplus = [&](double A) { return gain_of_amplitude(A) - k; };
    double high = delta_r, at_high = surplus(high);
    while (at_high > 0 && high < kMaxAmplitude * delta_r) at_high = surplus(high *= 2);
    return root_between(surplus, 0, high, 1 - k, at_high, kAmplitudeTolerance * high);
}

}  // namespace tunewright
