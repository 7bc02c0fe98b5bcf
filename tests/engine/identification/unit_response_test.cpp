// The responses of the model structures against closed forms, by superposition of the response to one step.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "engine/identification/fit/response.h"

namespace tunewright {
namespace {

constexpr double kL = 0.0123, kT = 0.05, kT3 = 0.02;
const std::vector<double> kMoves = {0, 0.11, 0.25, 0.2504, 0.6, 0.83}, kLevels = {1, -0.7, 0.2, 0.9, -1, 0.3};

/// The response to one step with its first and second derivatives.
struct Curves {
    std::function<double(double)> x, x1, x2;
};

/// Lags T and others in series, with or without an integrator: x = sum of c e^(-t/T), with a ramp.
Curves of_lags(const std::vector<double>& T, bool integrates) {
    const auto share = [T](std::size_t i) {
        double product = 1;
        for (std::size_t k = 0; k < T.size(); ++k) product *= k == i ? 1 : T[i] / (T[i] - T[k]);
        return product;
    };
    // The derivative of order d of the plain step response; -1 is its integral.
    const auto plain = [T, share](int d) {
        return [=](double t) {
            double sum = d < 0 ? t : d == 0 ? 1 : 0, whole = 0;
            for (std::size_t i = 0; i < T.size(); ++i) {
                sum -= share(i) * std::pow(-1 / T[i], d) * std::exp(-t / T[i]);
                whole += share(i) * T[i];
            }
            return d < 0 ? sum - whole : sum;
        };
    };
    const int lower = integrates ? 1 : 0;
    return {plain(-lower), plain(1 - lower), plain(2 - lower)};
}

/// a2 x'' + a1 x' + x = 1, complex roots.
Curves of_swing(double a1, double a2) {
    const double s = a1 / (2 * a2), w = std::sqrt(1 / a2 - s * s);
    return {[=](double t) { return 1 - std::exp(-s * t) * (std::cos(w * t) + s / w * std::sin(w * t)); },
            [=](double t) { return std::exp(-s * t) * std::sin(w * t) / (w * a2); },
            [=](double t) { return std::exp(-s * t) * (std::cos(w * t) - s / w * std::sin(w * t)) / a2; }};
}

double superposed(const std::function<double(double)>& one, double t) {
    double sum = 0, before = 0;
    for (std::size_t j = 0; j < kMoves.size(); ++j) {
        if (t >= kMoves[j] + kL) sum += (kLevels[j] - before) * one(t - kMoves[j] - kL);
        before = kLevels[j];
    }
    return sum;
}

ModelShape shape_of(Structure structure, double T, double ratio) {
    return {structure, {kL, std::log(T), std::log(ratio), 0, std::log(kT3)}};
}

void expect_response(const ModelShape& shape, const Curves& curves, const std::vector<double>& times) {
    UnitResponse out;
    unit_response(times, {kMoves, kLevels}, shape, 2, out);
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double x = superposed(curves.x, times[i]), x1 = superposed(curves.x1, times[i]);
        ASSERT_NEAR(out.x[i], x, 1e-11 * (1 + std::abs(x))) << name_of(shape.structure) << " at " << times[i];
        ASSERT_NEAR(out.x1[i], x1, 1e-10 * (1 / kT3 + std::abs(x1))) << name_of(shape.structure) << " at " << times[i];
        ASSERT_NEAR(out.x2[i], superposed(curves.x2, times[i]), 1e-9 / (kT3 * kT3)) << name_of(shape.structure);
    }
}

std::vector<double> times_of(const std::string& kind) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> part(0, 1);
    std::vector<double> t = {0};
    while (t.back() < 1) {
        const bool even = kind == "even" || (kind == "mixed" && std::fmod(t.back(), 0.2) < 0.1);
        t.push_back(even ? t.back() + 1.0 / 1024 : t.back() + part(random) / 500);
        if (kind == "repeated" && random() % 5 == 0) t.push_back(t.back());
    }
    return t;
}

void expect_all_responses(const std::vector<double>& t) {
    using enum Structure;
    expect_response(shape_of(fopdt, kT, 1), of_lags({kT}, false), t);
    expect_response(shape_of(ipdt, kT, 1), of_lags({}, true), t);
    expect_response(shape_of(ipdt_lag, kT, 1), of_lags({kT}, true), t);
    expect_response(shape_of(unstable, 0.4, 1), of_lags({-0.4}, false), t);
    const double a1 = 0.05 + 0.03, ratio = 0.05 * 0.03 / (a1 * a1);
    for (const Structure quadratic : {sopdt, sopdt_zero})
        expect_response(shape_of(quadratic, a1, ratio), of_lags({0.05, 0.03}, false), t);
    expect_response(shape_of(ipdt_second, a1, ratio), of_lags({0.05, 0.03}, true), t);
    expect_response(shape_of(third, a1, ratio), of_lags({0.05, 0.03, kT3}, false), t);
    expect_response(shape_of(sopdt, kT, 2), of_swing(kT, 2 * kT * kT), t);
}

TEST(UnitResponses, FollowTheClosedForms) {
    for (const char* kind : {"even", "jittered", "mixed", "repeated"}) {
        SCOPED_TRACE(kind);
        expect_all_responses(times_of(kind));
    }
}

}  // namespace
}  // namespace tunewright
