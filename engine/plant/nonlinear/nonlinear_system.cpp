#include "engine/plant/nonlinear/nonlinear_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/plant/expression/tokens.h"
#include "engine/plant/nonlinear/nonlinear_steady_state.h"

namespace tunewright {
namespace {

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

// With derivatives in N directions, the first of them `first`.
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
                         quoted(given.name) + " is no parameter of this plant."};
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
    double sum = 0;  // one test for all: 0 * inf is not a number
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
