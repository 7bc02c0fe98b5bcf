#include "engine/simulation/linear/response_end.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kMaxTailShare = 1e-10;                                        // of the absolute error's integral
constexpr double kValueRounding = 8 * std::numeric_limits<double>::epsilon();  // of y; in the integral of e it is
                                                                               // multiplied by t

}  // namespace

SteadyState steady_state(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs) {
    const DelaySystem s = make_delay_system(plant, controller);
    const int n = s.n + 1;
    std::vector<double> A(Index(n * n), 0.0), rhs(Index(n), 0.0);
    for (int i = 0; i < s.n; ++i) {
        for (int j = 0; j < s.n; ++j) A[Index(i * n + j)] = s.F[Index(i * s.n + j)];
        A[Index(i * n + s.n)] = s.G[Index(i)];
        rhs[Index(i)] = -s.H[Index(i)] * inputs.r;
        A[Index(s.n * n + i)] = s.M[Index(i)];
    }
    A[Index(n * n - 1)] = s.N - 1;
    rhs[Index(s.n)] = -(s.R * inputs.r + inputs.d);
    auto solution = solve(A, rhs, n);
    SteadyState steady;
    if (!solution) return steady;
    const double v = solution->back();
    solution->pop_back();
    steady.exists = true;
    const std::vector<double>& x = *solution;
    steady.u = v - inputs.d;
    steady.y = s.Z * v;
    for (int i = 0; i < s.n; ++i) steady.y += s.Y[Index(i)] * x[Index(i)];
    if (s.integral_state >= 0) {
        steady.y = inputs.r;
        steady.error_integral = error_integral_in_states(s, controller.filter, x);
    }
    return steady;
}

SteadyState steady_outputs(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs) {
    const double gain = plant.integrators() == 0 ? plant.low_frequency_gain() : 1;
    if (controller.Ki == 0 || plant.integrators() < 0 || gain == 0) return steady_state(plant, controller, inputs);
    SteadyState steady;
    steady.exists = true;
    steady.y = inputs.r;
    steady.u = (plant.integrators() == 0 ? inputs.r / gain : 0) - inputs.d;
    // The final value of the integral part, with y_f = r_f = r; then as in error_integral_in_states().
    const double integral = (steady.u - controller.Kp * (controller.b - 1) * inputs.r) / controller.Ki;
    const bool filtered = controller.filter.type == FilterType::measurement_first_order ||
                          controller.filter.type == FilterType::measurement_second_order;
    steady.error_integral = integral + (controller.setpoint_lag - (filtered ? controller.filter.Tf : 0)) * inputs.r;
    return steady;
}

double error_integral_in_states(const DelaySystem& system, const Filter& filter, const std::vector<double>& x) {
    // The integral of y - y_f follows from the filter's own equation: Tf y_f, or Tf y_f + Tf z/2 with z = Tf y_f'.
    const int integral = system.integral_state;
    double sum = x[Index(integral)];
    // In the same way the integral of r - r_f is T r_f.
    if (system.setpoint_state >= 0) sum += system.setpoint_lag * x[Index(system.setpoint_state)];
    switch (filter.type) {
        case FilterType::measurement_first_order: return sum - filter.Tf * x[Index(integral - 1)];
        case FilterType::measurement_second_order:
            return sum - filter.Tf * (x[Index(integral - 2)] + 0.5 * x[Index(integral - 1)]);
        default: return sum;
    }
}

void ErrorTail::add(const ResponseNode& a, const ResponseNode& b, double r) {
    const double h = b.t - a.t, ea = std::abs(r - a.y), eb = std::abs(r - b.y);
    largest_ = std::max(largest_, std::abs(b.y));
    absolute_error_ += 0.5 * h * (ea + eb);
    first_moment_ += 0.5 * h * (a.t * ea + b.t * eb);
}

bool ErrorTail::little_is_left(double rest, double e, double t, double fraction) const {
    rest = std::abs(rest);
    e = std::abs(e);
    // From t on, e^(-t/tau) has the integral tau and the first moment tau (t + tau): tau = rest/e.
    return rest <= kMaxTailShare * absolute_error_ + kValueRounding * largest_ * t ||
           rest * (t * e + rest) <= fraction * first_moment_ * e;
}

}  // namespace tunewright
