// Loops on nonlinear plants compared with independent integrators and independently written equations.
#include <cvode/cvode.h>
#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/simulation/nonlinear/nonlinear_response.h"
#include "tests/engine/plant/nonlinear_plants.h"

#ifndef SUN_COMM_NULL  // SUNDIALS before version 7
#define SUN_COMM_NULL nullptr
#endif

namespace tunewright {
namespace {

using CvodeRates = std::function<void(double t, const double* x, double* dx)>;

int call(sunrealtype t, N_Vector x, N_Vector dx, void* rates) {
    (*static_cast<const CvodeRates*>(rates))(t, N_VGetArrayPointer(x), N_VGetArrayPointer(dx));
    return 0;
}

void check(int flag) {
    if (flag < 0) throw std::runtime_error("CVODE failed with " + std::to_string(flag));
}

/// x at `samples` even times from 0 to t_end, both included. Absolute tolerances are relative to `sizes`. The
/// integrator is SUNDIALS' CVODE (backward differentiation formulas, Hindmarsh et al. 2005), which shares no code with
/// the engine.
std::vector<std::vector<double>> cvode_states(const CvodeRates& rates, std::vector<double> x, double t_end, int samples,
                                              double relative_tolerance, const std::vector<double>& sizes) {
    const auto n = static_cast<sunindextype>(x.size());
    std::vector<double> absolute;
    for (const double size : sizes) absolute.push_back(relative_tolerance * size);
    SUNContext context = nullptr;
    check(SUNContext_Create(SUN_COMM_NULL, &context));
    N_Vector state = N_VMake_Serial(n, x.data(), context), tolerances = N_VMake_Serial(n, absolute.data(), context);
    SUNMatrix matrix = SUNDenseMatrix(n, n, context);
    SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
    void* memory = CVodeCreate(CV_BDF, context);
    CvodeRates own = rates;
    check(CVodeInit(memory, call, 0, state));
    check(CVodeSVtolerances(memory, relative_tolerance, tolerances));
    check(CVodeSetUserData(memory, &own));
    check(CVodeSetLinearSolver(memory, solver, matrix));
    check(CVodeSetMaxNumSteps(memory, 10'000'000));
    std::vector<std::vector<double>> states = {x};
    for (int i = 1; i < samples; ++i) {
        double reached = 0;
        check(CVode(memory, t_end * i / (samples - 1), state, &reached, CV_NORMAL));
        states.push_back(x);
    }
    CVodeFree(&memory);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(state);
    N_VDestroy(tolerances);
    SUNContext_Free(&context);
    return states;
}

constexpr int kSamples = 201;
constexpr double kTj = 493.87;

struct Tank {
    double CA, T;
};

Tank rates(double CA, double T, double Tj) {
    const double reaction = 4.71e8 * std::exp(-8000 / T) * CA;
    return {1 - CA - reaction, 400 - T - 200 * reaction + Tj - T};
}

/// The PID law with a derivative filter, limits and back-calculation, written independently: states I (of u) and x_f.
struct Law {
    double Kp, Ti, Td = 0, Tf = 0.1, c = 0, min = -HUGE_VAL, max = HUGE_VAL, delta_r = HUGE_VAL;

    double command(double r, double y, double I, double x_f) const {
        return Kp * (r - y) + I + Kp * Td * (c * r - y - x_f) / Tf;
    }
    double u(double r, double y, double I, double x_f) const { return std::clamp(command(r, y, I, x_f), min, max); }
    double I_rate(double r, double y, double I, double x_f) const {
        const double e = r - y, phi = std::isinf(delta_r) ? e : std::exp(-e * e / (2 * delta_r * delta_r)) * e;
        const double Tt = Td > 0 ? std::sqrt(Ti * Td) : Ti;
        return Kp / Ti * phi + (u(r, y, I, x_f) - command(r, y, I, x_f)) / Tt;
    }
    double x_f_rate(double r, double y, double x_f) const { return (c * r - y - x_f) / Tf; }

    ParallelPid gains() const {
        ParallelPid gains{.Kp = Kp, .Ki = Kp / Ti, .Kd = Kp * Td, .c = c};
        if (Td > 0) gains.filter = {FilterType::derivative, Tf};
        return gains;
    }
};

struct OracleCase {
    const char* name;
    const char* output;
    Law law;
    double r, d, horizon;
    std::vector<double> initial = {};
};

std::vector<OracleCase> oracle_cases() {
    return {
        {"PI", "T", {.Kp = 4.8, .Ti = 0.194}, 10, 0, 4},
        {"PI, load", "T", {.Kp = 4.8, .Ti = 0.194}, 0, -30, 4},
        {"PID", "CA", {.Kp = -1229, .Ti = 1.38, .Td = 0.13}, 0.1416, 0, 4},
        {"PID, kick", "CA", {.Kp = -1342.7, .Ti = 0.95, .Td = 0.0524, .c = 1}, 0.05, 10, 4},
        {"PI, limits", "T", {.Kp = 15, .Ti = 0.1667, .min = -30, .max = 60}, 10, 0, 4},
        {"PID, narrow limits", "CA", {.Kp = -11753, .Ti = 0.2, .Td = 0.05, .min = -100, .max = 60}, 0.05, 5, 4},
        {"NPID", "T", {.Kp = 2, .Ti = 0.1, .Td = 0.02, .Tf = 0.05, .delta_r = 6}, 10, 0, 4},
        {"from elsewhere", "T", {.Kp = 4.8, .Ti = 0.194, .Td = 0.05}, 5, 0, 4, {0.6, 380}},
    };
}

NonlinearResponse response_to(const OracleCase& c, double L) {
    NonlinearPlant plant = cstr(c.output);
    plant.L = L;
    NonlinearOptions options;
    options.horizon = c.horizon;
    options.samples = kSamples;
    options.initial = c.initial;
    options.actuator = ActuatorLimits{c.law.min, c.law.max};
    if (std::isfinite(c.law.delta_r)) options.delta_r = c.law.delta_r;
    return simulate_nonlinear(made_system(plant), c.law.gains(), {c.r, c.d}, options);
}

Tank start_of(const OracleCase& c) {
    const auto steady = made_system(cstr(c.output));
    if (!c.initial.empty()) return {c.initial[0], c.initial[1]};
    return {steady.x_steady()[0], steady.x_steady()[1]};
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    double largest = 0;
    for (const double value : b) largest = std::max(largest, std::abs(value));
    for (std::size_t i = 1; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance * largest) << i;
}

TEST(NonlinearOracle, LoopsOnTheTankAreCvodes) {
    for (const OracleCase& c : oracle_cases()) {
        SCOPED_TRACE(c.name);
        const bool of_T = std::string(c.output) == "T";
        const double y_steady = made_system(cstr(c.output)).y_steady();
        const auto y_of = [&](const double* x) { return (of_T ? x[1] : x[0]) - y_steady; };
        const Tank start = start_of(c);
        const double x0[2] = {start.CA, start.T};
        const auto states = cvode_states(
            [&](double, const double* x, double* dx) {
                const double y = y_of(x);
                const Tank f = rates(x[0], x[1], kTj + c.law.u(c.r, y, x[2], x[3]) + c.d);
                dx[0] = f.CA;
                dx[1] = f.T;
                dx[2] = c.law.I_rate(c.r, y, x[2], x[3]);
                dx[3] = c.law.x_f_rate(c.r, y, x[3]);
            },
            {start.CA, start.T, 0, -y_of(x0)}, c.horizon, kSamples, 1e-12, {0.1, 1, 1, of_T ? 1 : 0.01});
        std::vector<double> y, u;
        for (const auto& x : states) {
            y.push_back(y_of(x.data()));
            u.push_back(c.law.u(c.r, y.back(), x[2], x[3]));
        }
        const auto response = response_to(c, 0);
        ASSERT_EQ(response.ended, "");
        expect_same(response.even.y, y, 1e-6);
        expect_same(response.even.u, u, 1e-6);
        EXPECT_EQ(response.limited, std::isfinite(c.law.max));
    }
}

/// The classical Runge-Kutta method with a step of L/n and u(t - L) from a table of its values at half steps.
struct DelayedLoop {
    std::vector<double> y, u;
};

DelayedLoop tiny_steps(const OracleCase& c, double L, int n) {
    const bool of_T = std::string(c.output) == "T";
    const double y_steady = made_system(cstr(c.output)).y_steady(), h = L / n;
    const auto steps = std::size_t(std::lround(c.horizon / h));
    const auto y_of = [&](const std::array<double, 4>& x) { return (of_T ? x[1] : x[0]) - y_steady; };
    const auto f = [&](const std::array<double, 4>& x, double w) {
        const double y = y_of(x);
        const Tank rate = rates(x[0], x[1], kTj + w);
        return std::array<double, 4>{rate.CA, rate.T, c.law.I_rate(c.r, y, x[2], x[3]), c.law.x_f_rate(c.r, y, x[3])};
    };
    const Tank start = start_of(c);
    std::array<double, 4> x = {start.CA, start.T, 0, 0};
    x[3] = -y_of(x);
    std::vector<double> w = {c.law.u(c.r, y_of(x), x[2], x[3]) + c.d};  // after t = 0
    DelayedLoop loop;
    const auto record = [&] {
        loop.y.push_back(y_of(x));
        loop.u.push_back(c.law.u(c.r, loop.y.back(), x[2], x[3]));
    };
    const std::size_t each = steps / (kSamples - 1);
    record();
    const auto then = [&](std::size_t step, double part) {  // w at (step + part) h - L, by a cubic through four values
        if (step < std::size_t(n)) return 0.0;
        const std::size_t i = step - std::size_t(n);
        if (part == 0) return w[i];
        if (part == 1) return w[i + 1];
        if (i == 0 || i + 2 >= w.size()) return i == 0 ? (3 * w[0] + 6 * w[1] - w[2]) / 8 : 0.5 * (w[i] + w[i + 1]);
        return (9 * (w[i] + w[i + 1]) - w[i - 1] - w[i + 2]) / 16;
    };
    for (std::size_t k = 0; k < steps; ++k) {
        const auto plus = [&](const std::array<double, 4>& d, double s) {
            auto at = x;
            for (std::size_t i = 0; i < 4; ++i) at[i] += s * d[i];
            return at;
        };
        const auto a = f(x, then(k, 0)), b = f(plus(a, h / 2), then(k, 0.5)), m = f(plus(b, h / 2), then(k, 0.5)),
                   e = f(plus(m, h), then(k, 1));
        for (std::size_t i = 0; i < 4; ++i) x[i] += h / 6 * (a[i] + 2 * b[i] + 2 * m[i] + e[i]);
        w.push_back(c.law.u(c.r, y_of(x), x[2], x[3]) + c.d);
        if ((k + 1) % each == 0) record();
    }
    return loop;
}

TEST(NonlinearOracle, LoopsWithDeadTimeAreThoseOfTinySteps) {
    constexpr double kL = 0.05;
    for (const OracleCase& c :
         {OracleCase{"PI", "T", {.Kp = 4.8, .Ti = 0.3}, 10, 0, 4},
          OracleCase{"PI, load", "T", {.Kp = 4.8, .Ti = 0.3}, 0, -30, 4},
          OracleCase{"PI, limits", "T", {.Kp = 8, .Ti = 0.3, .min = -30, .max = 60}, 10, 0, 4},
          OracleCase{"PID", "CA", {.Kp = -1229, .Ti = 1.38, .Td = 0.13}, 0.1, 0, 4},
          OracleCase{"PID, limits", "CA", {.Kp = -3000, .Ti = 0.9, .Td = 0.1, .min = -90, .max = 60}, 0.05, 0, 4}}) {
        SCOPED_TRACE(c.name);
        const auto response = response_to(c, kL);
        ASSERT_EQ(response.ended, "");
        EXPECT_EQ(response.limited, std::isfinite(c.law.max));
        const auto fine = tiny_steps(c, kL, 400);
        // Kinks at the limits are between the tiny steps.
        const double tolerance = response.limited ? 1e-5 : 1e-6;
        expect_same(response.even.y, fine.y, tolerance);
        expect_same(response.even.u, fine.u, tolerance);
    }
}

// A sensor chain a million times faster than the measured tank.
TEST(NonlinearOracle, AStiffPlantTakesFewSteps) {
    const NonlinearPlant plant{.states = {{"h", 1.0}, {"a", 1.0}, {"b", 1.0}},
                               .parameters = {},
                               .equations = {{"h", "u-sqrt(h)"}, {"a", "1e6*(h^2-a)"}, {"b", "3e5*(a-b^3)"}},
                               .input = {.name = "u", .nominal = 1},
                               .output = "b"};
    constexpr double kKp = 3, kKi = 2;
    NonlinearOptions options;
    options.horizon = 20;
    options.samples = kSamples;
    options.max_steps = 2000;
    const auto response = simulate_nonlinear(made_system(plant), {.Kp = kKp, .Ki = kKi}, {0.5, 0.2}, options);
    ASSERT_EQ(response.ended, "");
    const auto states = cvode_states(
        [&](double, const double* x, double* dx) {
            const double y = x[2] - 1;
            dx[0] = 1 + kKp * (0.5 - y) + x[3] + 0.2 - std::sqrt(x[0]);
            dx[1] = 1e6 * (x[0] * x[0] - x[1]);
            dx[2] = 3e5 * (x[1] - x[2] * x[2] * x[2]);
            dx[3] = kKi * (0.5 - y);
        },
        {1, 1, 1, 0}, 20, kSamples, 1e-12, {1, 1, 1, 1});
    std::vector<double> y;
    for (const auto& x : states) y.push_back(x[2] - 1);
    expect_same(response.even.y, y, 1e-6);
}

TEST(NonlinearOracle, UnitsOfTimeAndOutputDoNotMatter) {
    const NonlinearPlant minutes = cstr("CA");
    NonlinearPlant seconds = cstr("1000*CA");
    for (auto& equation : seconds.equations) equation.text = "(" + equation.text + ")/60";
    seconds.L = 3;
    NonlinearPlant delayed = minutes;
    delayed.L = 0.05;
    NonlinearOptions options;
    options.horizon = 4;
    options.samples = kSamples;
    options.actuator = ActuatorLimits{-100, 100};
    const auto a = simulate_nonlinear(made_system(delayed),
                                      {.Kp = -1229, .Ki = -900, .Kd = -160, .filter = {FilterType::derivative, 0.1}},
                                      {0.1, 5}, options);
    options.horizon = 240;
    const auto b = simulate_nonlinear(made_system(seconds),
                                      {.Kp = -1.229, .Ki = -0.015, .Kd = -9.6, .filter = {FilterType::derivative, 6}},
                                      {100, 5}, options);
    std::vector<double> scaled = b.even.y;
    for (double& y : scaled) y /= 1000;
    expect_same(scaled, a.even.y, 1e-6);
    expect_same(b.even.u, a.even.u, 1e-6);
}

TEST(NonlinearOracle, ATighterToleranceComesNearer) {
    const OracleCase c = oracle_cases()[2];
    NonlinearOptions options;
    options.horizon = c.horizon;
    options.samples = kSamples;
    const auto system = made_system(cstr(c.output));
    const auto at = [&](double tolerance) {
        options.tolerance = tolerance;
        return simulate_nonlinear(system, c.law.gains(), {c.r, c.d}, options).even.u;
    };
    const auto exact = at(1e-12), coarse = at(1e-5), fine = at(1e-8);
    double of_coarse = 0, of_fine = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        of_coarse = std::max(of_coarse, std::abs(coarse[i] - exact[i]));
        of_fine = std::max(of_fine, std::abs(fine[i] - exact[i]));
    }
    EXPECT_LT(of_coarse, 0.2);
    EXPECT_LT(of_fine, 1e-2 * of_coarse);
}

}  // namespace
}  // namespace tunewright
