#include "engine/plant/nonlinear/nonlinear_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "engine/expected.h"
#include "engine/number_text.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/plant/expression/program_run.h"
#include "engine/plant/expression/tokens.h"

namespace tunewright {
namespace {

constexpr int kMaxIterations = 100, kMaxHalvings = 40;
constexpr double kStateRounding = 1e-16;  // of the largest state: the rounding error of a state at 0
constexpr double kSufficientFall = 1e-4;  // of the decrease that is predicted for Newton's step (Armijo's rule)
constexpr double kNearFloor = 1e-6;       // of the largest state: smaller moves count as near for any state
constexpr double kSingularCutoff = 1e-11, kMaxStep = 0.1, kConvergedStep = 1e-9, kConvergedRates = 1e-10;

/// Seven digits, because users copy a steady state into a request.
std::string precise(double x) { return text(x, 7); }

/// States and their rates.
struct Iterate {
    std::vector<double> x, rates;
};

class SteadyStateSearch {
public:
    SteadyStateSearch(const NonlinearSystem& system, std::span<const double> start)
        : system_(system), n_(start.size()), u_(system.u_nominal()), start_(start.begin(), start.end()) {
        for (double& x : start_)
            if (std::abs(x) <= kStateRounding * largest(start)) x = 0;
    }

    Expected<std::vector<double>> run() {
        Iterate now{start_, std::vector<double>(n_)};
        if (!system_.rates(now.x, u_, now.rates)) return fault_at_start();
        double step_size = std::numeric_limits<double>::infinity();
        for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
            std::vector<double> A(n_ * n_), B(n_);
            if (!system_.jacobian(now.x, u_, A, B)) return iteration == 0 ? fault_at_start() : none_near(now);
            measure(now.x, A, B);
            const std::vector<double> step = newton_step(A, now.rates);
            step_size = largest(step);
            if (step_size == 0 || !advance(now, step, step_size)) break;
        }
        if (!(step_size < kConvergedStep) || !(norm(now.rates) < kConvergedRates)) return none_near(now);
        if (!is_near(now.x)) return too_far(now);
        return now.x;
    }

private:
    static double largest(std::span<const double> values) {
        double result = 0;
        for (const double value : values) result = std::max(result, std::abs(value));
        return result;
    }

    // Sets the sizes of the states and of the terms of each rate.
    void measure(const std::vector<double>& x, const std::vector<double>& A, const std::vector<double>& B) {
        state_size_.assign(n_, 0);
        for (std::size_t i = 0; i < n_; ++i)
            if (start_[i] != 0) state_size_[i] = std::max(std::abs(x[i]), std::abs(start_[i]));
        const std::vector<double> others = terms(A, B);
        for (std::size_t j = 0; j < n_; ++j)
            if (start_[j] == 0) state_size_[j] = std::max(size_from_others(others, A, j), std::abs(x[j]));
        rate_size_ = terms(A, B);
        for (double& size : rate_size_)
            if (!(size > 0)) size = 1;
    }

    // The largest term of each rate.
    std::vector<double> terms(const std::vector<double>& A, const std::vector<double>& B) const {
        std::vector<double> result(n_);
        for (std::size_t i = 0; i < n_; ++i) {
            result[i] = std::abs(B[i] * u_);
            for (std::size_t j = 0; j < n_; ++j)
                result[i] = std::max(result[i], std::abs(A[i * n_ + j]) * state_size_[j]);
        }
        return result;
    }

    // The size of a state that is 0, such as a speed: the value that would weigh as much as the other states in one of
    // the rates; 1 if there is none.
    double size_from_others(const std::vector<double>& others, const std::vector<double>& A, std::size_t j) const {
        double size = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < n_; ++i)
            if (A[i * n_ + j] != 0 && others[i] > 0) size = std::min(size, others[i] / std::abs(A[i * n_ + j]));
        return std::isfinite(size) ? size : 1;
    }

    double norm(const std::vector<double>& rates) const {
        double result = 0;
        for (std::size_t i = 0; i < n_; ++i) result = std::max(result, std::abs(rates[i] / rate_size_[i]));
        return result;
    }

    // The step relative to the sizes of the states.
    std::vector<double> newton_step(std::vector<double> A, const std::vector<double>& rates) const {
        std::vector<double> right(n_);
        for (std::size_t i = 0; i < n_; ++i) {
            for (std::size_t j = 0; j < n_; ++j) A[i * n_ + j] *= state_size_[j] / rate_size_[i];
            right[i] = -rates[i] / rate_size_[i];
        }
        return least_norm_solution(A, right, static_cast<int>(n_), kSingularCutoff);
    }

    // Moves along the step as far as the rates decrease; false if they do not.
    bool advance(Iterate& now, const std::vector<double>& step, double step_size) const {
        const double before = norm(now.rates);
        double length = std::min(1.0, kMaxStep / step_size);
        for (int halving = 0; halving < kMaxHalvings; ++halving, length /= 2) {
            Iterate next{now.x, std::vector<double>(n_)};
            for (std::size_t i = 0; i < n_; ++i) next.x[i] += length * step[i] * state_size_[i];
            if (next.x == now.x) return false;
            if (system_.rates(next.x, u_, next.rates) && norm(next.rates) < (1 - kSufficientFall * length) * before) {
                now = std::move(next);
                return true;
            }
        }
        return false;
    }

    bool is_near(const std::vector<double>& x) const {
        const double floor = kNearFloor * largest(start_);
        for (std::size_t i = 0; i < n_; ++i) {
            const double size = start_[i] == 0 ? 2 : std::max(std::abs(start_[i]), std::abs(x[i]));
            if (std::abs(x[i] - start_[i]) > std::max(0.5 * size, floor)) return false;
        }
        return true;
    }

    std::string states(const std::vector<double>& x) const {
        std::string result;
        for (std::size_t i = 0; i < n_; ++i)
            result += (i == 0 ? "" : ", ") + system_.description().states[i].name + " = " + precise(x[i]);
        return result;
    }

    static Error invalid(const std::string& message) { return {ErrorKind::invalid_argument, "plant/states", message}; }

    Error fault_at_start() const {
        return invalid("The equations cannot be evaluated at the operating point (" + states(start_) + ", " +
                       system_.description().input.name + " = " + precise(u_) +
                       "): " + system_.derivative_fault(start_, u_) + ".");
    }

    Error none_near(const Iterate& stuck) const {
        std::size_t worst = 0;
        for (std::size_t i = 1; i < n_; ++i)
            if (std::abs(stuck.rates[i] / rate_size_[i]) > std::abs(stuck.rates[worst] / rate_size_[worst])) worst = i;
        return invalid("There is no steady state near these states for " + system_.description().input.name + " = " +
                       precise(u_) + ": the search ended at " + states(stuck.x) + ", where d" +
                       system_.description().states[worst].name + "/dt is still " + precise(stuck.rates[worst]) +
                       ". Change input.nominal or the states.");
    }

    Error too_far(const Iterate& found) const {
        return invalid("There is no steady state near these states for " + system_.description().input.name + " = " +
                       precise(u_) + ": the next one is " + states(found.x) +
                       ". Give these states if you mean that one, or change input.nominal.");
    }

    const NonlinearSystem& system_;
    std::size_t n_;
    double u_;
    std::vector<double> start_, state_size_, rate_size_;
};

/// f(x, u_nominal) = 0 by Newton's method from `start`: scaled by the states' sizes, least-norm steps where the
/// Jacobian is singular (an integrating tank keeps the given level), damped until the rates decrease. The result is
/// accepted if Newton's step has fallen to rounding, the rates are 0 to 1e-10 of their terms, and no state has changed
/// by more than a factor of two (a state given as 0: by more than 1). Errors, invalid_argument: not finite at the start
/// or on the way (names the operation); no steady state near (reports the last iterate).
Expected<std::vector<double>> steady_state_near(const NonlinearSystem& system, std::span<const double> start) {
    return SteadyStateSearch(system, start).run();
}

constexpr int kMaxVariables = 21;  // 20 states and the input

template <class T>
struct Variables {
    std::array<T, kMaxVariables> values;
    std::size_t count;
    operator std::span<const T>() const { return {values.data(), count}; }  // NOLINT(google-explicit-constructor)
};

Variables<double> variables(std::span<const double> x, double u) {
    Variables<double> result;
    result.count = x.size() + 1;
    std::copy(x.begin(), x.end(), result.values.begin());
    result.values[x.size()] = u;
    return result;
}

// With derivatives in N directions, beginning with direction `first`.
template <int N>
Variables<Dual<N>> dual_variables(std::span<const double> x, double u, std::size_t first) {
    Variables<Dual<N>> result;
    result.count = x.size() + 1;
    for (std::size_t i = 0; i < result.count; ++i) {
        const double value = i < x.size() ? x[i] : u;
        result.values[i] = i >= first && i < first + N ? variable_dual<N>(value, i - first) : constant_dual<N>(value);
    }
    return result;
}

// d(outputs)/d(variables) of the first outputs of a program, `directions` variables wide, row by row.
template <int N>
bool derivatives(const Program& program, std::span<const double> x, double u, std::size_t outputs,
                 std::size_t directions, double* rows) {
    std::array<Dual<N>, kMaxVariables> out;
    bool finite = true;
    for (std::size_t first = 0; first < directions; first += N) {
        program.evaluate<Dual<N>>(dual_variables<N>(x, u, first), std::span(out.data(), outputs));
        for (std::size_t i = 0; i < outputs; ++i) {
            finite = finite && all_finite(out[i]);
            for (std::size_t j = first; j < std::min(first + N, directions); ++j)
                rows[i * directions + j] = derivative(out[i], j - first);
        }
    }
    return finite;
}

}  // namespace

Expected<NonlinearSystem> NonlinearSystem::make(const NonlinearPlant& plant) {
    auto compiled = compile_plant(plant);
    if (!compiled) return compiled.error();
    NonlinearSystem system;
    system.plant_ = plant;
    system.program_ = std::make_shared<const PlantProgram>(std::move(*compiled));
    std::vector<double> start;
    for (const auto& state : plant.states) start.push_back(state.value);
    auto steady = steady_state_near(system, start);
    if (!steady) return steady.error();
    system.x_steady_ = std::move(*steady);
    system.y_steady_ = system.output(system.x_steady_);
    if (!system.linearise())
        return Error{ErrorKind::invalid_argument, "plant/output",
                     "The output cannot be evaluated at the steady state: " +
                         system.derivative_fault(system.x_steady_, system.u_nominal()) + "."};
    return system;
}

Expected<NonlinearSystem> NonlinearSystem::with(const std::vector<NamedValue>& parameters) const {
    NonlinearPlant plant = plant_;
    for (const NamedValue& given : parameters) {
        const auto found = std::find_if(plant.parameters.begin(), plant.parameters.end(),
                                        [&](const Parameter& parameter) { return parameter.name == given.name; });
        if (found == plant.parameters.end())
            return Error{ErrorKind::invalid_argument, given.name,
                         quoted(given.name) + " is not a parameter of this plant."};
        found->value = given.value;
    }
    for (std::size_t i = 0; i < plant.states.size(); ++i) plant.states[i].value = x_steady_[i];
    return make(plant);
}

bool NonlinearSystem::linearise() {
    const auto n = x_steady_.size();
    std::vector<double> A(n * n);
    linearised_ = {
        .A = {}, .B = std::vector<double>(n), .C = std::vector<double>(n), .D = 0, .L = plant_.L, .uncertainty = {}};
    if (!std::isfinite(y_steady_) || !jacobian(x_steady_, u_nominal(), A, linearised_.B)) return false;
    for (std::size_t i = 0; i < n; ++i) linearised_.A.emplace_back(&A[i * n], &A[i * n] + n);
    return output_gradient(x_steady_, linearised_.C);
}

double NonlinearSystem::u_min() const { return plant_.input.min.value_or(-std::numeric_limits<double>::infinity()); }
double NonlinearSystem::u_max() const { return plant_.input.max.value_or(std::numeric_limits<double>::infinity()); }

bool NonlinearSystem::rates(std::span<const double> x, double u, std::span<double> dx) const {
    program_->joint.evaluate<double>(variables(x, u), dx.first(x.size()));
    double sum = 0;  // one test for all: 0 * inf is NaN
    for (std::size_t i = 0; i < x.size(); ++i) sum += 0 * dx[i];
    return sum == 0;
}

double NonlinearSystem::output(std::span<const double> x) const {
    double y;
    program_->output.evaluate<double>(variables(x, 0), std::span(&y, 1));
    return y;
}

bool NonlinearSystem::jacobian(std::span<const double> x, double u, std::span<double> A, std::span<double> B) const {
    const std::size_t n = x.size();
    std::array<double, kMaxVariables * kMaxVariables> rows;
    const bool finite = n < 3 ? derivatives<3>(program_->joint, x, u, n, n + 1, rows.data())
                              : derivatives<4>(program_->joint, x, u, n, n + 1, rows.data());
    for (std::size_t i = 0; i < n; ++i) {
        std::copy_n(&rows[i * (n + 1)], n, &A[i * n]);
        B[i] = rows[i * (n + 1) + n];
    }
    return finite;
}

bool NonlinearSystem::output_gradient(std::span<const double> x, std::span<double> C) const {
    return derivatives<4>(program_->output, x, 0, 1, x.size(), C.data());
}

std::string NonlinearSystem::domain_fault(std::span<const double> x, double u) const {
    std::string fault = program_->joint.fault<double>(variables(x, u), program_->joint.outputs());
    if (fault.empty()) return fault;
    fault[0] = fault[0] == 'e' ? 'E' : fault[0] == 'o' ? 'O' : fault[0];
    return fault + ".";
}

std::string NonlinearSystem::derivative_fault(std::span<const double> x, double u) const {
    for (std::size_t first = 0; first <= x.size(); first += 4) {
        auto fault = program_->joint.fault<Dual<4>>(dual_variables<4>(x, u, first), program_->joint.outputs());
        if (!fault.empty()) return fault;
    }
    return {};
}

}  // namespace tunewright
