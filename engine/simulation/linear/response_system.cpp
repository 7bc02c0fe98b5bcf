#include "engine/simulation/linear/response_system.h"

namespace tunewright {

using Index = std::size_t;

ResponseSystem make_response_system(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in) {
    return make_response_system(make_delay_system(plant, controller), in);
}

ResponseSystem make_response_system(const DelaySystem& loop, const StepInputs& in) {
    ResponseSystem system;
    system.s = loop;
    system.delayed = system.s.L > 0;
    if (!system.delayed) system.s = close_without_delay(system.s);
    const DelaySystem& s = system.s;
    system.in = in;
    // Plain loops: with Eigen's maps a whole response takes 1.5 % longer.
    const int n = s.n;
    system.n = n + 1;
    system.F.assign(Index(system.n * system.n), 0);
    system.G = s.G;
    system.G.push_back(s.Z);
    system.b.assign(Index(system.n), 0);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) system.F[Index(i * system.n + j)] = s.F[Index(i * n + j)];
        system.F[Index(n * system.n + i)] = s.Y[Index(i)];
        system.b[Index(i)] = s.H[Index(i)] * in.r;
    }
    system.outputs.assign(Index(4 * system.n), 0);
    for (int i = 0; i < n; ++i) {
        system.outputs[Index(4 * i)] = s.Y[Index(i)];
        system.outputs[Index(4 * i + 2)] = s.M[Index(i)];
        for (int j = 0; j < n; ++j) {
            system.outputs[Index(4 * j + 1)] += s.Y[Index(i)] * s.F[Index(i * n + j)];
            system.outputs[Index(4 * j + 3)] += s.M[Index(i)] * s.F[Index(i * n + j)];
        }
        system.MG += s.M[Index(i)] * s.G[Index(i)];
        system.YG += s.Y[Index(i)] * s.G[Index(i)];
        system.MH += s.M[Index(i)] * s.H[Index(i)] * in.r;
        system.YH += s.Y[Index(i)] * s.H[Index(i)] * in.r;
    }
    system.b[Index(n)] = -in.r;
    if (!system.delayed) {
        // Here v consists of the load alone, with the algebraic loop solved.
        for (int i = 0; i < system.n; ++i) system.b[Index(i)] += system.G[Index(i)] * in.d;
        // The error's integral also contains the set point's direct effect through the plant.
        system.b[Index(n)] = s.Z * in.d + s.Y_r * in.r - in.r;
    }
    return system;
}

ResponseNode node_at(const ResponseSystem& system, double t, std::span<const double> x, Signal v) {
    auto [y, y_slope, u, u_slope] = outputs_of(system, system.delayed ? v : Signal{system.in.d, 0}, 1);
    const auto n = Index(system.s.n);
    for (Index i = 0; i < n; ++i) {
        const double* out = &system.outputs[4 * i];
        y += out[0] * x[i];
        y_slope += out[1] * x[i];
        u += out[2] * x[i];
        u_slope += out[3] * x[i];
    }
    return {.t = t, .y = y, .y_slope = y_slope, .u = u, .u_slope = u_slope, .error_integral = -x[n]};
}

}  // namespace tunewright
