#include "engine/code/settings.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "engine/number_text.h"

namespace tunewright::code {
namespace {

constexpr int kMaxDigits = 17;  // digits that identify a double

// The shortest decimal near `x` that `gives` accepts; x itself if it accepts none.
template <class Test>
double shortest(double x, const Test& gives) {
    for (int digits = 1; digits <= kMaxDigits; ++digits) {
        const double candidate = std::strtod(text(x, digits).c_str(), nullptr);
        if (gives(candidate)) return candidate;
    }
    return x;
}

double shortest_time(double infinite_if_none) {
    return infinite_if_none > 0 ? infinite_if_none : std::numeric_limits<double>::infinity();
}

// Ti and Td without their sign, 0 if there is none.
double integral_time(const ParallelPid& gains) { return gains.Ki == 0 ? 0 : std::abs(gains.Kp / gains.Ki); }
double derivative_time(const ParallelPid& gains) { return gains.Kp == 0 ? 0 : std::abs(gains.Kd / gains.Kp); }

double one_two_five_below(double x) {
    constexpr double kRoundingFactor = 1 + 1e-12;  // tolerates rounding, so that a computed 0.2 counts as 0.2
    const double power = std::floor(std::log10(x * kRoundingFactor));
    for (const char* digit : {"5", "2"}) {
        const double value = std::strtod((std::string(digit) + "e" + text(power)).c_str(), nullptr);
        if (value <= x * kRoundingFactor) return value;
    }
    return std::strtod(("1e" + text(power)).c_str(), nullptr);
}

}  // namespace

std::optional<double> seconds_in(const std::string& label) {
    struct Unit {
        const char* label;
        double seconds;
    };
    for (const Unit& unit : {Unit{"s", 1}, {"ms", 0.001}, {"min", 60}, {"h", 3600}, {"d", 86400}})
        if (label == unit.label) return unit.seconds;
    return std::nullopt;
}

SampledPid in_seconds(SampledPid pid, double seconds) {
    pid.gains.Ki /= seconds;
    pid.gains.Kd *= seconds;
    pid.gains.filter.Tf *= seconds;
    pid.gains.setpoint_lag *= seconds;
    pid.Ts *= seconds;
    pid.computation_delay *= seconds;
    return pid;
}

Settings settings_of(const ParallelPid& gains) {
    Settings settings;
    const double leading = gains.Kp != 0 ? gains.Kp : gains.Ki != 0 ? gains.Ki : gains.Kd;
    settings.direct = leading < 0;
    const double sign = settings.direct ? -1 : 1;
    // Adding 0 turns -0 into 0.
    settings.Kp = sign * gains.Kp + 0.0;
    settings.Ki = sign * gains.Ki + 0.0;
    settings.Kd = sign * gains.Kd + 0.0;
    settings.ideal = settings.Kp > 0 && settings.Ki >= 0 && settings.Kd >= 0;
    if (!settings.ideal) return settings;
    const double Kp = settings.Kp, Ki = settings.Ki, Kd = settings.Kd;
    if (Ki > 0) settings.Ti = shortest(Kp / Ki, [&](double Ti) { return Kp / Ti == Ki; });
    if (Kd > 0) settings.Td = shortest(Kd / Kp, [&](double Td) { return Kp * Td == Kd; });
    return settings;
}

std::optional<double> tracking_time(const ParallelPid& gains) {
    const double Ti = integral_time(gains), Td = derivative_time(gains);
    if (Ti == 0) return std::nullopt;
    return Td > 0 ? std::sqrt(Ti * Td) : Ti;
}

std::optional<double> proposed_sample_time(const ParallelPid& gains, double longest) {
    longest =
        std::min(longest, std::min(shortest_time(integral_time(gains)), shortest_time(derivative_time(gains))) / 10);
    if (gains.filter.type != FilterType::none) longest = std::min(longest, gains.filter.Tf);
    if (!std::isfinite(longest)) return std::nullopt;
    return one_two_five_below(longest);
}

}  // namespace tunewright::code
