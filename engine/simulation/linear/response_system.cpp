#include "engine/simulation/linear/response_system.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/linear_algebra.h"

namespace tunewright {
namespace {

using Index = std::size_t;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kOfFastest = 0.25;    // of the fastest mode's time: the cubic through a step's ends follows it
constexpr double kOfDeadTime = 0.125;  // a power of 2, as the lengths of the steps double

}  // namespace

ResponseSystem make_response_system(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in) {
    ResponseSystem system;
    system.s = make_delay_system(plant, controller);
    system.delayed = system.s.L > 0;
    if (!system.delayed) system.s = close_without_delay(system.s);
    const DelaySystem& s = system.s;
    system.in = in;
    const Eigen::Index n = s.n;
    system.n = s.n + 1;
    system.F.assign(Index(system.n * system.n), 0);
    system.G = s.G;
    system.G.push_back(s.Z);
    system.b.assign(Index(system.n), 0);
    Eigen::Map<Matrix> F(system.F.data(), n + 1, n + 1);
    Eigen::Map<Eigen::VectorXd> b(system.b.data(), n + 1);
    F.topLeftCorner(n, n) = Eigen::Map<const Matrix>(s.F.data(), n, n);
    F.row(n).head(n) = Eigen::Map<const Eigen::RowVectorXd>(s.Y.data(), n);
    b.head(n) = in.r * Eigen::Map<const Eigen::VectorXd>(s.H.data(), n);
    system.MF = row_times(s.M, s.F);
    system.YF = row_times(s.Y, s.F);
    system.MG = dot(s.M, s.G);
    system.YG = dot(s.Y, s.G);
    system.MH = dot(s.M, s.H) * in.r;
    system.YH = dot(s.Y, s.H) * in.r;
    b[n] = -in.r;
    if (!system.delayed) {
        // v is the load alone here, with the algebraic loop solved.
        b += in.d * Eigen::Map<const Eigen::VectorXd>(system.G.data(), n + 1);
        // The error's integral also sees what the set point feeds through the plant's direct term.
        b[n] = s.Z * (s.R * in.r + in.d) - in.r;
    }
    return system;
}

double fastest_rate(const ResponseSystem& system, const LinearPlant& plant, const ParallelPid& controller) {
    double fastest = 0;
    for (const auto pole : plant.poles()) fastest = std::max(fastest, std::abs(pole));
    if (controller.filter.type != FilterType::none) fastest = std::max(fastest, 1 / controller.filter.Tf);
    if (!system.delayed)
        for (const auto pole : eigenvalues(system.s.F, system.s.n)) fastest = std::max(fastest, std::abs(pole));
    return fastest;
}

double first_step(const ResponseSystem& system, double fastest) {
    const double by_rate = fastest > 0 ? kOfFastest / fastest : std::numeric_limits<double>::infinity();
    return system.delayed ? std::min(kOfDeadTime * system.s.L, by_rate) : by_rate;
}

double own_time(const LinearPlant& plant) {
    const double time = plant.time_scale();
    return time > 0 ? time : 1;
}

ResponseNode node_at(const ResponseSystem& system, double t, const std::vector<double>& x, Signal v) {
    const DelaySystem& s = system.s;
    if (!system.delayed) v = {system.in.d, 0};
    ResponseNode node;
    node.t = t;
    node.u = s.N * v.value + s.R * system.in.r;
    node.u_slope = system.MG * v.value + system.MH + s.N * v.slope;
    node.y = s.Z * v.value;
    node.y_slope = system.YG * v.value + system.YH + s.Z * v.slope;
    if (!system.delayed) node.y += s.Z * s.R * system.in.r;
    // One loop: with four calls of dot() a whole response takes 3 to 4 % longer.
    for (int i = 0; i < s.n; ++i) {
        const double xi = x[Index(i)];
        node.u += s.M[Index(i)] * xi;
        node.u_slope += system.MF[Index(i)] * xi;
        node.y += s.Y[Index(i)] * xi;
        node.y_slope += system.YF[Index(i)] * xi;
    }
    node.error_integral = -x[Index(s.n)];
    return node;
}

}  // namespace tunewright
