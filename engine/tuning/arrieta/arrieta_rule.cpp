#include "engine/tuning/arrieta/arrieta_rule.h"

#include <algorithm>
#include <cmath>

namespace tunewright {
namespace {

constexpr double kN = 10;
constexpr double kLevelTolerance = 1e-9;

constexpr ArrietaConstants kFree = {1.1410, -0.9664, 0.1468, 1.0860, 0.4896, 0.2775, 0.3726, 0.7098, -0.0409};

constexpr ArrietaLevel kTable1[] = {
    {1.4, {0.4306, -1.0190, 0.1926, 0.7894, 0.4286, 0.2557, 0.3599, 0.9592, -0.0127}},
    {1.6, {0.5678, -1.0250, 0.2601, 0.8323, 0.5382, 0.3507, 0.3111, 0.8894, -0.0118}},
    {1.8, {0.6825, -1.0240, 0.3026, 0.7821, 0.6490, 0.4511, 0.2938, 0.7956, -0.0188}},
    {2.0, {0.7699, -1.0270, 0.3490, 0.7402, 0.7309, 0.5307, 0.2750, 0.9478, 0.0034}},
};

constexpr ArrietaLevel kTable2[] = {
    {0.00, kFree},
    {0.25, {0.8787, -0.9280, 0.2033, 0.8154, 0.6431, 0.4502, 0.2794, 0.8765, -0.0149}},
    {0.35, {0.7490, -0.9348, 0.2669, 0.8664, 0.6033, 0.3874, 0.2757, 0.8698, -0.0070}},
    {0.45, {0.6292, -0.9444, 0.3195, 0.8871, 0.5847, 0.3466, 0.2804, 0.8471, -0.0037}},
    {0.55, {0.5252, -0.9492, 0.3494, 0.8755, 0.5830, 0.3275, 0.2949, 0.8123, -0.0055}},
};

double power_law(double a, double b, double c, double tau) { return a * std::pow(tau, b) + c; }

}  // namespace

const ArrietaConstants& arrieta_free() { return kFree; }
std::span<const ArrietaLevel> arrieta_Ms_levels() { return kTable1; }
std::span<const ArrietaLevel> arrieta_degradation_levels() { return kTable2; }

const ArrietaConstants* arrieta_column(std::span<const ArrietaLevel> table, double level) {
    const auto at = std::ranges::find_if(
        table, [level](const ArrietaLevel& column) { return std::abs(column.level - level) < kLevelTolerance; });
    return at == table.end() ? nullptr : &at->constants;
}

ArrietaConstants arrieta_equation_9(double M, ArrietaC3 c3) {
    const bool printed = c3 == ArrietaC3::printed;
    return {.a1 = (-0.3112 * M + 1.6250) * M - 1.2340,
            .b1 = (0.0188 * M - 0.0753) * M - 0.9509,
            .c1 = (-0.1319 * M + 0.7042) * M - 0.5334,
            .a2 = (-0.5300 * M + 1.7030) * M - 0.5511,
            .b2 = (-0.1731 * M + 1.0970) * M - 0.7700,
            .c2 = (-0.0963 * M + 0.7899) * M - 0.6629,
            .a3 = (0.1875 * M - 0.7735) * M + 1.0740,
            .b3 = (1.3870 * M - 4.7810) * M + 4.9470,
            .c3 = printed ? (0.1331 * M - 0.4733) * M + 0.4032 : (0.1331 * M - 0.4320) * M + 0.3330};
}

IdealPid arrieta_pid(const ArrietaConstants& k, const Fopdt& model) {
    const double tau = model.L / model.T;
    IdealPid pid;
    pid.Kp = power_law(k.a1, k.b1, k.c1, tau) / model.K;
    pid.Ti = power_law(k.a2, k.b2, k.c2, tau) * model.T;
    pid.Td = power_law(k.a3, k.b3, k.c3, tau) * model.T;
    if (pid.Td > 0) pid.filter = {FilterType::derivative, pid.Td / kN};
    return pid;
}

}  // namespace tunewright
