#include "engine/plant/nonlinear/lie_derivatives.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/error.h"
#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/numerics/matrix/transmission_zeros.h"
#include "engine/plant/expression/taylor.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {
namespace {

enum class InputDegree { absent, affine, nonlinear };

// Degree in the input of every register, from the structure of the equations: abstract interpretation of the operations
// alone, so that (u + 1)^2 - u^2 counts as nonlinear.
class DegreeAnalysis {
public:
    explicit DegreeAnalysis(const Program& program)
        : program_(program),
          first_(program.registers() - static_cast<int>(program.instructions().size())),
          degrees_(static_cast<std::size_t>(program.registers()), InputDegree::absent) {
        degrees_[static_cast<std::size_t>(program.variables()) - 1] = InputDegree::affine;
        auto next = degrees_.begin() + first_;
        for (const Instruction& instruction : program.instructions()) *next++ = of(instruction);
    }

    InputDegree at(int where) const { return degrees_[static_cast<std::size_t>(where)]; }

    // The instruction that makes this register nonlinear.
    int culprit(int where) const {
        for (;;) {
            const Instruction& i = program_.instructions()[static_cast<std::size_t>(where - first_)];
            int next = -1;
            for (const int operand : {i.a, i.b, i.c})
                if (at(operand) == InputDegree::nonlinear) next = operand;
            if (next < 0) return where - first_;
            where = next;
        }
    }

private:
    bool is_zero(int where) const {
        const int index = where - program_.variables();
        return index >= 0 && where < first_ && program_.constants()[static_cast<std::size_t>(index)] == 0;
    }

    InputDegree of(const Instruction& i) const {
        const InputDegree a = at(i.a), b = at(i.b), c = at(i.c);
        const InputDegree any = std::max({a, b, c});
        switch (i.operation) {
            case Operation::add:
            case Operation::subtract:
            case Operation::negate: return any;
            case Operation::multiply:
                if (is_zero(i.a) || is_zero(i.b)) return InputDegree::absent;
                return a != InputDegree::absent && b != InputDegree::absent ? InputDegree::nonlinear : any;
            case Operation::divide: return b == InputDegree::absent ? a : InputDegree::nonlinear;
            case Operation::select: return a == InputDegree::absent ? std::max(b, c) : InputDegree::nonlinear;
            default: return any == InputDegree::absent ? any : InputDegree::nonlinear;
        }
    }

    const Program& program_;
    int first_;
    std::vector<InputDegree> degrees_;
};

/// The error if x' = f(x) + g(x) u does not hold: unsupported, `where` = "plant/equations/T", with the operation and
/// its place. Empty if it holds.
std::optional<Error> not_affine(const NonlinearSystem& system) {
    const Program& program = system.program();
    const DegreeAnalysis analysis(program);
    for (int i = 0; i < system.order(); ++i) {
        const int at = program.output_register(i);
        if (analysis.at(at) != InputDegree::nonlinear) continue;
        const std::string& state = system.description().states[static_cast<std::size_t>(i)].name;
        return Error{ErrorKind::unsupported, "plant/equations/" + state,
                     program.place(analysis.culprit(at)) + ": the input " + system.description().input.name +
                         " enters nonlinearly; this needs equations of the form f(x) + g(x) " +
                         system.description().input.name +
                         ". Add the actuator as a state to bring them into this "
                         "form."};
    }
    return std::nullopt;
}

// Values are compared with the sum of the sizes of their terms, and with the values in the neighbourhood.
constexpr double kRelativeTermRounding = 1e-10;  // of the terms' sizes: at least the accuracy of a derivative of order
                                                 // 20
constexpr double kMaxVanishingShare = 1e-8;      // of the largest value in the neighbourhood: 0 at the operating point
constexpr double kNeighbourhood = 0.02;  // of the states: large enough to show that a zero is isolated, small enough to
                                         // stay valid
constexpr int kNeighbours = 12;

// |C| |A|^(r-1) |B|: the size of the terms of L_g L_f^(r-1) h at x, without cancellation. Negative outside the domain.
std::vector<double> term_sizes(const NonlinearSystem& system, std::span<const double> x, int highest) {
    const auto n = x.size();
    std::vector<double> A(n * n), B(n), C(n), sizes;
    if (!system.jacobian(x, system.u_nominal(), A, B) || !system.output_gradient(x, C)) return {};
    for (auto* part : {&A, &B, &C})
        for (double& value : *part) value = std::abs(value);
    std::vector<double> next(n);
    for (int r = 1; r <= highest; ++r) {
        sizes.push_back(dot(C, B));
        multiply(A, B, next);
        B.swap(next);
    }
    return sizes;
}

// Points around the steady state, spread evenly (Weyl's sequence of square roots of primes); the first is itself.
std::vector<std::vector<double>> neighbourhood(const NonlinearSystem& system) {
    constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71};
    const auto steady = system.x_steady();
    std::vector<std::vector<double>> points = {{steady.begin(), steady.end()}};
    for (int k = 1; k <= kNeighbours; ++k) {
        std::vector<double> point(steady.begin(), steady.end());
        for (std::size_t i = 0; i < point.size(); ++i) {
            const double turn = k * std::sqrt(kPrimes[i]);
            const double size = point[i] == 0 ? 1 : std::abs(point[i]);
            point[i] += kNeighbourhood * size * (2 * (turn - std::floor(turn)) - 1);
        }
        points.push_back(std::move(point));
    }
    return points;
}

struct InputEffect {
    bool anywhere = false, at_the_operating_point = false;
};

// Decides whether L_g L_f^(r-1) h vanishes identically or only at the operating point.
InputEffect input_effect(const NonlinearSystem& system, int r, const std::vector<std::vector<double>>& points,
                         const std::vector<std::vector<double>>& sizes) {
    InputEffect effect;
    double largest = 0, here = 0;
    LieDerivatives lie;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (sizes[i].empty() || !lie_derivatives(system, r, points[i], lie)) continue;
        const double value = std::abs(lie.of_g);
        if (value <= kRelativeTermRounding * sizes[i][static_cast<std::size_t>(r) - 1]) continue;
        effect.anywhere = true;
        largest = std::max(largest, value);
        if (i == 0) here = value;
    }
    effect.at_the_operating_point = effect.anywhere && here > kMaxVanishingShare * largest;
    return effect;
}

Error unsupported(const std::string& message) { return {ErrorKind::unsupported, "plant/output", message}; }

}  // namespace

bool lie_derivatives(const NonlinearSystem& system, int r, std::span<const double> x, LieDerivatives& out) {
    using Coefficient = Dual<1>;
    const Program& rates = system.program();
    const Program& output = system.output_program();
    const int n = system.order(), length = rates.length(n);
    TaylorTable<Coefficient> flow(rates, r);
    for (int i = 0; i < n; ++i) flow.series(i)[0] = constant_dual<1>(x[static_cast<std::size_t>(i)]);
    Coefficient* u = flow.series(n);
    u[0] = variable_dual<1>(0, 0);  // f is affine in u: at u = 0 the value is f, the slope is g
    for (int k = 1; k <= r; ++k) u[k] = constant_dual<1>(0);
    for (int k = 0; k < r; ++k) {
        flow.sweep(k, length);
        for (int i = 0; i < n; ++i) flow.series(i)[k + 1] = flow.series(rates.output_register(i))[k] * (1.0 / (k + 1));
    }

    TaylorTable<Coefficient> along(output, r);
    for (int i = 0; i < n; ++i) std::copy_n(flow.series(i), r + 1, along.series(i));
    for (int k = 0; k <= r; ++k) {
        set_constant(along.series(n)[k], 0);
        along.sweep(k, output.length(1));
    }
    const Coefficient* y = along.series(output.output_register(0));
    out.of_f.resize(static_cast<std::size_t>(r) + 1);
    double factorial = 1;
    bool finite = true;
    for (int k = 0; k <= r; ++k) {
        if (k > 0) factorial *= k;
        out.of_f[static_cast<std::size_t>(k)] = factorial * y[k].v;
        finite = finite && std::isfinite(out.of_f[static_cast<std::size_t>(k)]);
    }
    out.of_g = factorial * y[r].d;
    return finite && std::isfinite(out.of_g);
}

Expected<int> relative_degree(const NonlinearSystem& system) {
    if (auto error = not_affine(system)) return *error;
    const auto points = neighbourhood(system);
    std::vector<std::vector<double>> sizes;
    sizes.reserve(points.size());
    for (const auto& point : points) sizes.push_back(term_sizes(system, point, system.order()));
    const std::string& u = system.description().input.name;
    for (int r = 1; r <= system.order(); ++r) {
        const InputEffect effect = input_effect(system, r, points, sizes);
        if (effect.at_the_operating_point) return r;
        if (effect.anywhere)
            return unsupported("The relative degree is undefined at the operating point: " + u +
                               " enters the derivative of order " + std::to_string(r) +
                               " of the output near it, but its coefficient is 0 at the operating point. Choose "
                               "another operating point or output.");
    }
    return unsupported("The input " + u + " enters no derivative of the output up to the order " +
                       std::to_string(system.order()) + " of the plant, so it cannot move this output.");
}

ZeroDynamics zero_dynamics(const NonlinearSystem& system) {
    const StateSpace& linear = system.linearised();
    const auto n = static_cast<std::size_t>(system.order());
    const std::vector<double> A = row_by_row(linear.A);
    ZeroDynamics result;
    result.zeros = transmission_zeros(A, linear.B, linear.C, 0, static_cast<int>(n)).value_or(result.zeros);
    double scale = 0;
    for (const double a : A) scale = std::max(scale, std::abs(a));
    for (const auto& zero : result.zeros) result.stable = result.stable && zero.real() < -kRelativeTermRounding * scale;
    return result;
}

}  // namespace tunewright
