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

/// Which circles the Nyquist curve stays out of: those of Ms and Mt, or the smallest one around both.
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

/// Within which the searches by gradient keep the controller's times, in 1/reference frequency: beyond, the design is
/// an integral alone, a PI, or lives below every frequency of interest, and a filter tied to Td leaves the frequency
/// grid.
constexpr double kMinTi = 1e-6, kMinTd = 2e-4, kMaxTd = 300;

/// What a search answers.
/// The curvature that a search has seen around a design: of ln(cost) and the active limits over the logarithms of the
/// parameters, symmetric. A search that starts near by learns it in as many steps as there are parameters.
using Curvature = std::array<std::array<double, 3>, 3>;

struct DesignResult {
    DesignPoint x{};
    double log_cost = 0;
    bool stopped = false;  ///< the report asked to stop: x is the best so far
    std::optional<Curvature> curvature = {};
};

struct DesignProblem {
    const LinearPlant* plant = nullptr;       ///< nominal: the cost is its own
    std::span<const LinearPlant> others;      ///< stability and the limits must hold on these too
    const MeasuredPlant* measured = nullptr;  ///< in their place: measured points, with objective load_ie
    bool pid = true;
    double sign = 1;  ///< of Kp
    FilterRule filter;
    PeakLimits limits;
    Objective objective = Objective::load_iae;
    double rho = 0.5;         ///< weight of the load in `weighted`
    double load_optimum = 1;  ///< IAE of the load-optimal design, for `weighted`
    double setpoint_optimum = 1;
    std::vector<DesignPoint> optimal_for_part = {};  ///< those designs: the weighted optimum's valley may be of one
    std::optional<double> reference = {};  ///< where the loop is looked for; empty: reference_frequency() says

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
/// falls through -180 degrees; else 1/L; else where it last falls through -135 degrees, as two lags far apart do at the
/// faster one; else the filter's or the slowest lag's corner.
double reference_frequency(const DesignProblem& problem);

/// Where else to look on an integrating plant. Its resonance may be so lightly damped that a gain which keeps the peak
/// within Ms crosses over far below: at that crossover, and half way to the usual reference in the logarithm, where a
/// filter takes the peak down. Behind two integrators, with no phase to spare, where the other lags have used up little
/// of it. Empty: nowhere.
std::vector<double> slower_references(const DesignProblem& problem);

}  // namespace tunewright::robust
