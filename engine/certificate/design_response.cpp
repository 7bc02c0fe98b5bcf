#include "engine/certificate/design_response.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "engine/certificate/loop_terms.h"
#include "engine/loop/stability.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright::certificate {

ParallelPid controller_at(const CertificateProblem& problem, const std::array<double, 3>& unknowns) {
    ParallelPid pid{.Kp = unknowns[0], .Ki = unknowns[1], .Kd = 0, .b = 1, .c = 0, .filter = {}, .setpoint_lag = 0};
    double Tf = problem.Tf;
    if (problem.structure == CertifiedStructure::pid_tied) {
        Tf = unknowns[2] / kN;
        pid.Kd = unknowns[0] * unknowns[2];
    } else if (problem.structure == CertifiedStructure::pid_fixed) {
        pid.Kd = unknowns[2];
    }
    if (Tf > 0) pid.filter = {FilterType::measurement_second_order, Tf};
    return pid;
}

double frequency_scale(const CertificateProblem& problem, double time_scale) {
    GainsOf<double> design(CertifiedBox{problem.design, problem.design});
    constexpr int kPoints = 900;
    double largest = 0, at = 1;
    for (int i = 0; i <= kPoints; ++i) {
        const double w = std::pow(10.0, -4 + 9.0 * i / kPoints) / time_scale;
        const auto point = point_at(problem, ComplexOf<double>{0.0, w});
        const double S = size(point.Q) / size(terms_at(problem.structure, design, point).centre);
        if (!(S > largest)) continue;
        largest = S;
        at = w;
    }
    return 1.5 * at;
}

std::optional<LoadResponse> load_response(const CertificateProblem& problem, const LinearPlant& plant,
                                          const std::array<double, 3>& unknowns, double half_period) {
    const ParallelPid pid = controller_at(problem, unknowns);
    const auto loop = Loop::make(plant, pid);
    if (!loop || !count_unstable_poles(*loop).stable()) return std::nullopt;
    ResponseOptions options;
    options.settled = 1e-5;
    options.tolerance = 1e-5;
    const StepResponse response = simulate_linear(plant, pid, {.r = 0, .d = 1}, options);
    if (!response.settles) return std::nullopt;
    LoadResponse result;
    result.IAE = integral_of_absolute_error(response.nodes, 0, response.error_integral_final);
    double sum = 0;
    for (std::size_t i = 1; i < response.nodes.size() && sum < 0.999 * result.IAE; ++i) {
        const auto &a = response.nodes[i - 1], &b = response.nodes[i];
        sum += 0.5 * (std::abs(a.y) + std::abs(b.y)) * (b.t - a.t);
        result.time_of_most = b.t;
    }
    if (!(half_period > 0)) return result;
    for (const SignChange& change : changes_of_sign(response.nodes, 0)) {
        const auto &a = response.nodes[change.node - 1], &b = response.nodes[change.node];
        const double angle = (a.t + change.part * (b.t - a.t)) * std::numbers::pi / half_period;
        if (angle > 0 && angle < std::numbers::pi) result.sign.changes.push_back(angle);
    }
    const auto largest = std::max_element(response.nodes.begin(), response.nodes.end(),
                                          [](const auto& a, const auto& b) { return std::abs(a.y) < std::abs(b.y); });
    int sign = largest->y < 0 ? -1 : 1;
    for (const double angle : result.sign.changes)
        if (angle < largest->t * std::numbers::pi / half_period) sign = -sign;
    result.sign.first = sign;
    return result;
}

}  // namespace tunewright::certificate
