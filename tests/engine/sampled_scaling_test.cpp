// Answers about sampled, limited and typed loops scale: in other units of time, of y and of u they are the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "engine/controller/product/catalogue.h"
#include "engine/request/tune.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

/// Time in units of 1/time, y in units of 1/gain. For this plant other units of u are other units of y, and of a load
/// and limits; the load stays 1 here, so that it is combined with a y of any size.
struct OtherUnits {
    double time = 1, gain = 1;
};

struct SampledCase {
    const char* name;
    PlantModel (*plant)(OtherUnits);
    double Ts;
};

const SampledCase kSampledCases[] = {
    {"lag and dead time",
     [](OtherUnits s) -> PlantModel { return Fopdt{.K = 2 * s.gain, .T = 10 * s.time, .L = 3 * s.time}; }, 0.5},
    {"four lags",
     [](OtherUnits s) -> PlantModel {
         const double T = 1 / s.time;
         return Zpk{.K = s.gain * T * T * T * T, .zeros = {}, .poles = {-T, -T, -T, -T}, .L = 0};
     },
     0.2},
    {"integrator", [](OtherUnits s) -> PlantModel { return Ipdt{.K = 0.1 * s.gain / s.time, .L = 4 * s.time}; }, 0.4},
    {"resonance",
     [](OtherUnits s) -> PlantModel {
         return OscillatorySopdt{.K = 1.5 * s.gain, .T = 2 * s.time, .zeta = 0.3, .L = 0.5 * s.time};
     },
     0.1},
    // A tank with a free outflow, level 1 and inflow 1 at rest.
    {"equations",
     [](OtherUnits s) -> PlantModel {
         return NonlinearPlant{.states = {{"h", s.gain}},
                               .parameters = {{"A", s.time / s.gain}, {"c", 1 / std::sqrt(s.gain)}},
                               .equations = {{"h", "(q - c*sqrt(h))/A"}},
                               .input = {.name = "q", .nominal = 1},
                               .output = "h",
                               .L = 0.5 * s.time};
     },
     0.2},
};

const OtherUnits kOtherUnits[] = {{1e-9, 1e-9}, {1e-9, 1}, {1e-9, 1e9}, {1, 1e-9}, {1, 1e7},
                                  {1, 1e9},     {4e6, 1},  {1e9, 1e-9}, {1e9, 1},  {1e9, 1e9}};

struct LoopKind {
    std::string name;
    std::optional<ActuatorLimits> limits = {};
    const product::Product* product = nullptr;
};

// No command in a case is exactly at a limit, where rounding would decide.
const LoopKind kLoopKinds[] = {{"sampled"},
                               {"limited on the way", ActuatorLimits{-2, 1.0837}},
                               {"at rest at a limit", ActuatorLimits{-2, 0.4137}}};

// The cases' unit of time for a block. With 1 s an integral time is 2.5 s, between two steps of a block that counts
// whole seconds, where rounding would decide.
constexpr double kSecondsPerTime = 1.04;

Expected<TuningResult> sampled_answer(const SampledCase& c, OtherUnits s, const char* method, const LoopKind& kind) {
    TuningRequest request;
    request.subject = test::subject_of(c.plant(s));
    request.tune = {MethodRequest{.method = method, .options = {}}};
    request.evaluate.points = 0;
    request.evaluate.setpoint_step = s.gain;  // so that u stays as it is
    request.evaluate.optimum_at_Ms = false;
    request.evaluate.actuator = kind.limits;
    device::DeviceModel device{.product = kind.product, .Ts = c.Ts * s.time};
    if (kind.product != nullptr) {
        // The block counts in seconds and in fractions of its spans: both are unchanged.
        const double seconds = c.Ts * kSecondsPerTime;
        device.context = product::Context::with_spans({0, 100 * s.gain, -50, 50}, seconds);
        device.context.loop_clock_s = seconds;
        device.context.seconds_per_time = kSecondsPerTime / s.time;
    }
    request.device = device;
    return tune(request, {});
}

struct NearIn {
    double tolerance;

    void operator()(const char* name, const Figure& one, const Figure& other, double unit) const {
        ASSERT_EQ(one.has_value(), other.has_value()) << name;
        if (one) {
            EXPECT_NEAR(*other / unit, *one, tolerance * std::abs(*one)) << name;
        }
    }
};

void same_loop(const DeviceLoop& one, const DeviceLoop& other, OtherUnits s, const NearIn& near) {
    ASSERT_EQ(one.robustness.stable, other.robustness.stable);
    near("Ms", one.robustness.Ms, other.robustness.Ms, 1);
    near("Mt", one.robustness.Mt, other.robustness.Mt, 1);
    near("gain margin", one.robustness.gain_margin, other.robustness.gain_margin, 1);
    const Performance &a = one.performance, &b = other.performance;
    near("load IAE", a.load.IAE, b.load.IAE, s.gain * s.time);
    near("load peak", a.load.peak, b.load.peak, s.gain);
    near("load TV", a.load.TV, b.load.TV, 1);
    near("recovery", a.load.recovery_time, b.load.recovery_time, s.time);
    near("set-point IAE", a.setpoint.IAE, b.setpoint.IAE, s.gain * s.time);
    near("set-point TV", a.setpoint.TV, b.setpoint.TV, 1);
    near("settling", a.setpoint.settling_time, b.setpoint.settling_time, s.time);
}

void sampled_scales(const char* method, const LoopKind& kind, const NearIn& near, std::span<const OtherUnits> units) {
    for (const SampledCase& c : kSampledCases) {
        const auto one = sampled_answer(c, {}, method, kind);
        for (const OtherUnits s : units) {
            SCOPED_TRACE(std::string(c.name) + ", " + method + ", " + kind.name + ", time " +
                         std::to_string(std::log10(s.time)) + ", gain " + std::to_string(std::log10(s.gain)));
            const auto other = sampled_answer(c, s, method, kind);
            ASSERT_EQ(one.has_value(), other.has_value()) << (one ? other.error().message : one.error().message);
            if (!one) continue;
            const TuningEntry &a = one->controllers[0], &b = other->controllers[0];
            ASSERT_EQ(a.on_device.has_value(), b.on_device.has_value());
            ASSERT_EQ(a.evaluation->warnings.size(), b.evaluation->warnings.size());
            near("Ms of the ideal loop", a.evaluation->robustness.Ms, b.evaluation->robustness.Ms, 1);
            near("load IAE of the ideal loop", a.evaluation->performance.load.IAE, b.evaluation->performance.load.IAE,
                 s.gain * s.time);
            if (a.on_device) same_loop(a.on_device->loop, b.on_device->loop, s, near);
        }
    }
}

// A rule's controller is the same to rounding; times at which a response leaves a band are as accurate as its steps.
TEST(SampledScaling, OfARule) {
    for (const LoopKind& kind : kLoopKinds) sampled_scales("simc", kind, {1e-6}, kOtherUnits);
}

// A simplex takes other steps after different rounding.
TEST(SampledScaling, OfADesignForSampling) {
    constexpr OtherUnits kFew[] = {{1e-9, 1e-9}, {1, 1e7}, {4e6, 1}, {1e9, 1e9}};
    for (const LoopKind& kind : kLoopKinds) sampled_scales("robust", kind, {2e-4}, kFew);
}

// Every product: in another unit of time all of its numbers stay the same; in another unit of y those of a block that
// counts in fractions of its span do.
TEST(SampledScaling, OfEveryProduct) {
    constexpr OtherUnits kTimes[] = {{1e-9, 1}, {1e9, 1}}, kBoth[] = {{1e-9, 1e9}, {1e9, 1e-9}};
    for (const product::Product& product : product::catalogue()) {
        const bool by_span = std::ranges::any_of(product.parameters, [](const product::Parameter& parameter) {
            return parameter.role == product::ParameterRole::gain && parameter.term.Sy != 0;
        });
        const LoopKind kind{std::string(product.id), {}, &product};
        sampled_scales("simc", kind, {1e-6},
                       by_span ? std::span<const OtherUnits>(kBoth) : std::span<const OtherUnits>(kTimes));
    }
}

}  // namespace
}  // namespace tunewright
