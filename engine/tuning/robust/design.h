// The robust design problem: a plant, limits on the loop's peaks, a filter rule, and the controller's free parameters
// in logarithms.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/frequency_response.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/tuning/peak_limits.h"

namespace tunewright::robust {

/// The circles that the Nyquist curve must avoid: those of Ms and Mt, or the smallest one around both.
enum class Constraint { circles, m_circle };

enum class Objective { load_iae, load_ie, setpoint_iae, weighted };

/// fast: scan and quadratic programming; nelder_mead, grid: the searches of the paper.
enum class SearchKind { fast, nelder_mead, grid };

/// Tf as a fixed time or as a fraction of Td; neither: no filter (PI).
struct FilterRule {
    std::optional<double> Tf;
    std::optional<double> Tf_over_Td;
};

/// Logarithms of |Kp|, Ti, Td. PI uses the first two.
using DesignPoint = std::array<double, 3>;

/// Bounds of the controller's times in searches by gradient, in 1/reference frequency. Beyond them the design is pure
/// integral action, a PI, or much slower than every frequency of interest, and a filter tied to Td leaves the frequency
/// grid.
constexpr double kMinTi = 1e-6, kMinTd = 2e-4, kMaxTd = 300;

/// The curvature that a search has found around a design: of ln(cost) and the active limits over the logarithms of the
/// parameters, symmetric. A search that starts nearby without it needs as many steps as there are parameters to find
/// it.
using Curvature = std::array<std::array<double, 3>, 3>;

struct DesignResult {
    DesignPoint x{};
    double log_cost = 0;
    bool stopped = false;  ///< stopped by the report: x is the best so far
    std::optional<Curvature> curvature = {};
};

struct DesignProblem {
    const LinearPlant* plant = nullptr;       ///< nominal: the cost is computed on it
    std::span<const LinearPlant> others;      ///< stability and the limits must hold on these too
    const MeasuredPlant* measured = nullptr;  ///< in place of plants: measured points, with objective load_ie
    bool pid = true;
    double sign = 1;  ///< of Kp
    FilterRule filter;
    PeakLimits limits;
    Objective objective = Objective::load_iae;
    double rho = 0.5;         ///< weight of the load in the objective `weighted`
    double load_optimum = 1;  ///< IAE of the load-optimal design, for `weighted`
    double setpoint_optimum = 1;
    std::vector<DesignPoint> optimal_for_part = {};  ///< those designs, because the weighted optimum may lie near one
                                                     ///< of them
    std::optional<double> reference = {};            ///< frequency around which the loop is searched; empty:
                                                     ///< reference_frequency()

    int dimension() const { return pid ? 3 : 2; }
    std::size_t plants() const { return 1 + others.size(); }
    const LinearPlant& plant_at(std::size_t i) const { return i == 0 ? *plant : others[i - 1]; }
};

inline double filter_time(const DesignProblem& problem, double Td) {
    if (problem.filter.Tf) return *problem.filter.Tf;
    return problem.filter.Tf_over_Td ? *problem.filter.Tf_over_Td * Td : 0;
}

inline IdealPid controller_at(const DesignProblem& problem, const DesignPoint& x) {
    IdealPid pid;
    pid.Kp = problem.sign * std::exp(x[0]);
    pid.Ti = std::exp(x[1]);
    pid.Td = problem.pid ? std::exp(x[2]) : 0;
    const double Tf = filter_time(problem, pid.Td);
    if (Tf > 0) pid.filter = {FilterType::measurement_second_order, Tf};
    return pid;
}

/// The first frequency where the phase of P (right-half-plane poles mirrored; with the filter, if its Tf is fixed)
/// falls through -180 degrees; else 1/L; else the frequency at which it last falls through -135 degrees, which is the
/// faster one of two very different lags; else the filter's or the slowest lag's corner.
double reference_frequency(const DesignProblem& problem);

/// Further reference frequencies of an integrating plant; empty if there are none. A resonance may be so lightly damped
/// that a gain which keeps its peak within Ms has a much lower crossover: then that crossover, and the logarithmic
/// middle between it and the usual reference, where a filter lowers the peak. With two integrators, which leave no
/// phase to spare: the frequency at which the other lags have little effect.
std::vector<double> slower_references(const DesignProblem& problem);

}  // namespace tunewright::robust
