// Answers scale: a plant in other units of time and of y has the same controller, peaks and figures in these units.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/request/tune.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

/// Time in units of 1/time, y in units of 1/gain.
struct Units {
    double time = 1, gain = 1;
};

struct Case {
    const char* name;
    Plant (*plant)(Units);
};

const Case kCases[] = {
    {"fopdt", [](Units s) -> Plant { return Fopdt{.K = 2 * s.gain, .T = 10 * s.time, .L = 3 * s.time}; }},
    {"lag-dominated", [](Units s) -> Plant { return Fopdt{.K = 2 * s.gain, .T = 1000 * s.time, .L = s.time}; }},
    {"sopdt",
     [](Units s) -> Plant { return Sopdt{.K = 0.7 * s.gain, .T1 = 8 * s.time, .T2 = 3 * s.time, .L = 2 * s.time}; }},
    {"oscillating",
     [](Units s) -> Plant {
         return OscillatorySopdt{.K = 1.5 * s.gain, .T = 2 * s.time, .zeta = 0.3, .L = 0.5 * s.time};
     }},
    {"integrating", [](Units s) -> Plant { return Ipdt{.K = 0.1 * s.gain / s.time, .L = 4 * s.time}; }},
    {"integrating with a lag",
     [](Units s) -> Plant {
         return Zpk{.K = 0.05 * s.gain / (s.time * s.time), .zeros = {}, .poles = {0.0, -0.5 / s.time}, .L = s.time};
     }},
    {"high order without dead time",
     [](Units s) -> Plant {
         Zpk plant{.K = s.gain, .zeros = {}, .poles = {}, .L = 0};
         for (const double lag : {1.0, 0.9, 0.5, 0.3}) {
             plant.poles.emplace_back(-1 / (lag * s.time));
             plant.K /= lag * s.time;
         }
         return plant;
     }},
    {"transfer function",
     [](Units s) -> Plant {
         const double T = s.time;
         return TransferFunction{.num = {s.gain}, .den = {T * T * T * T, 4 * T * T * T, 6 * T * T, 4 * T, 1}, .L = T};
     }},
    {"non-minimum phase",
     [](Units s) -> Plant {
         return Zpk{
             .K = -s.gain / s.time, .zeros = {2 / s.time}, .poles = {-1 / s.time, -0.5 / s.time}, .L = 0.2 * s.time};
     }},
    {"unstable", [](Units s) -> Plant { return Fopdt{.K = 2 * s.gain, .T = -10 * s.time, .L = s.time}; }},
};

const Units kUnits[] = {{1e-9, 1e-9}, {1e-9, 1}, {1e-9, 1e9}, {1e-3, 1}, {0.3, 1e-9}, {0.3, 7},
                        {1e3, 1},     {1e6, 1},  {1e9, 1e-9}, {1e9, 1},  {1e9, 1e9}};

Expected<TuningResult> answer(const Case& c, Units s, const std::string& method, const std::string& controller) {
    TuningRequest request;
    request.subject = test::subject_of(c.plant(s));
    request.tune = {MethodRequest{.method = method, .options = {}}};
    request.tune[0].options.set("controller", controller);
    request.evaluate.points = 0;
    request.evaluate.load_step = 1 / s.gain;  // y moves by as much as the set point
    request.evaluate.setpoint_step = 1;
    request.evaluate.optimum_at_Ms = false;
    return tune(request, {});
}

/// The comparison for each figure.
struct Comparison {
    double tolerance;

    void operator()(const char* name, const std::optional<double>& one, const std::optional<double>& other,
                    double unit) const {
        ASSERT_EQ(one.has_value(), other.has_value()) << name;
        if (one) {
            EXPECT_NEAR(*other / unit, *one, tolerance * std::abs(*one)) << name;
        }
    }
};

void same_settings(const Evaluation& one, const Evaluation& other, Units s, const Comparison& near) {
    const ParallelPid a = gains(one.controller), b = gains(other.controller);
    near("Kp", a.Kp, b.Kp, 1 / s.gain);
    near("Ki", a.Ki, b.Ki, 1 / s.gain / s.time);
    near("Kd", a.Kd, b.Kd, s.time / s.gain);
    near("Tf", a.filter.Tf, b.filter.Tf, s.time);
}

void same_margins(const Robustness& a, const Robustness& b, Units s, const Comparison& near) {
    near("Ms", a.Ms, b.Ms, 1);
    near("Mt", a.Mt, b.Mt, 1);
    near("Mks", a.Mks, b.Mks, 1 / s.gain);
    near("gain margin", a.gain_margin, b.gain_margin, 1);
    near("phase margin", a.phase_margin_deg, b.phase_margin_deg, 1);
    near("delay margin", a.delay_margin, b.delay_margin, s.time);
}

template <class Figures>
void same_indices(const Figures& a, const Figures& b, Units s, const Comparison& near) {
    near("IAE", a.IAE, b.IAE, s.time);
    near("ISE", a.ISE, b.ISE, s.time);
    near("ITAE", a.ITAE, b.ITAE, s.time * s.time);
    near("TV", a.TV, b.TV, 1 / s.gain);
}

void same_answer(const Evaluation& one, const Evaluation& other, Units s, const Comparison& near) {
    same_margins(one.robustness, other.robustness, s, near);
    const Performance &a = one.performance, &b = other.performance;
    same_indices(a.setpoint, b.setpoint, s, near);
    same_indices(a.load, b.load, s, near);
    near("rise time", a.setpoint.rise_time, b.setpoint.rise_time, s.time);
    near("settling time", a.setpoint.settling_time, b.setpoint.settling_time, s.time);
    near("peak", a.load.peak, b.load.peak, 1);
    near("recovery time", a.load.recovery_time, b.load.recovery_time, s.time);
    ASSERT_EQ(one.warnings.size(), other.warnings.size());
    for (std::size_t i = 0; i < one.warnings.size(); ++i) EXPECT_EQ(one.warnings[i].code, other.warnings[i].code);
    EXPECT_EQ(one.verification.stability_methods_agree, other.verification.stability_methods_agree);
}

void scales(const std::string& method, const std::string& controller,
            void (*compare)(const Evaluation&, const Evaluation&, Units)) {
    for (const Case& c : kCases) {
        const auto one = answer(c, {}, method, controller);
        for (const Units s : kUnits) {
            SCOPED_TRACE(std::string(c.name) + " " + method + " " + controller + ", time " +
                         std::to_string(std::log10(s.time)) + ", gain " + std::to_string(std::log10(s.gain)) +
                         " decades");
            const auto other = answer(c, s, method, controller);
            ASSERT_EQ(one.has_value(), other.has_value()) << (other ? "" : other.error().message);
            if (one) compare(*one->controllers[0].evaluation, *other->controllers[0].evaluation, s);
        }
    }
}

void rules_compare(const Evaluation& one, const Evaluation& other, Units s) {
    same_settings(one, other, s, {1e-6});
    same_answer(one, other, s, {1e-6});
}

TEST(Scaling, OfSimc) {
    scales("simc", "PI", rules_compare);
    scales("simc", "PID", rules_compare);
}

TEST(Scaling, OfLambdaTuning) {
    scales("lambda", "PI", rules_compare);
    scales("lambda", "PID", rules_compare);
}

TEST(Scaling, OfAmigo) {
    scales("amigo", "PI", rules_compare);
    scales("amigo", "PID", rules_compare);
}

/// The optimum is flat: its cost scales exactly, its settings only roughly.
void optimum_compare(const Evaluation& one, const Evaluation& other, Units s) {
    const Comparison near{1e-6};
    near("IAE", one.performance.load.IAE, other.performance.load.IAE, s.time);
    near("Ms", one.robustness.Ms, other.robustness.Ms, 1);
}

TEST(Scaling, OfTheRobustOptimum) {
    scales("robust", "PI", optimum_compare);
    scales("robust", "PID", optimum_compare);
}

}  // namespace
}  // namespace tunewright
