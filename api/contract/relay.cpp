#include "api/contract/relay.h"

#include "api/contract/plant/typed.h"
#include "api/contract/result/evaluation.h"
#include "api/contract/terms.h"
#include "api/describe/codec.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright::api {

const Description<UltimateTest>& ultimate_contract() {
    static const auto description = [] {
        using U = UltimateTest;
        Description<U> d("UltimateTest", "The result of an experiment with a proportional controller alone.");
        d.field("Ku", &U::Ku, number({.not_zero = true}),
                "Gain at which the loop oscillates; negative for a plant with negative gain.",
                {.required = true, .unit = "u/y"})
            .field("Pu", &U::Pu, number({.exclusive_minimum = 0}), "Period of that oscillation.",
                   {.required = true, .unit = "time"})
            .field("K", &U::K, maybe(number({.not_zero = true})), "Static gain, if it is known; with the sign of Ku.",
                   {.unit = "y/u"})
            .check([](const Json&, U& test, Reader& reader) {
                if (const auto fault = test.fault()) reader.fault_below(fault->where, 1, fault->message);
            });
        return d;
    }();
    return description;
}

const Description<UltimatePoint>& ultimate_point_contract() {
    static const auto description = [] {
        Description<UltimatePoint> d("UltimatePoint", "A gain, and the period at which the loop oscillates with it.");
        d.field("Ku", &UltimatePoint::Ku, number(), "Ultimate gain.", {.required = true, .unit = "u/y"})
            .field("Pu", &UltimatePoint::Pu, number(), "Period.", {.required = true, .unit = "time"});
        return d;
    }();
    return description;
}

static const Description<ShiftedPoint>& shifted_point_contract() {
    static const auto description = [] {
        Description<ShiftedPoint> d("ShiftedPoint", "G(sigma + j 2 pi/Pu) = A e^(j phi) (Liu and Gao, Eq. 9).");
        d.field("sigma", &ShiftedPoint::sigma, only_answered(number()), "Shift.", {.unit = "1/time"})
            .field("A", &ShiftedPoint::A, only_answered(number()), "Magnitude.", {.unit = "y/u"})
            .field("phi", &ShiftedPoint::phi, only_answered(number()), "Angle in (-2 pi, 0].", {.unit = "rad"});
        return d;
    }();
    return description;
}

const Description<LimitCycle>& limit_cycle_contract() {
    static const auto description = [] {
        Description<LimitCycle> d("LimitCycle", "The steady oscillation of a relay test.");
        d.field("Pu", &LimitCycle::Pu, only_answered(number()), "Period.", {.required = true, .unit = "time"})
            .field("Au", &LimitCycle::Au, only_answered(number()), "|G(j 2 pi/Pu)| (Liu and Gao, Eq. 4).",
                   {.required = true, .unit = "y/u"})
            .field("phi_u", &LimitCycle::phi_u, only_answered(number()), "Its angle, in (-2 pi, 0].",
                   {.required = true, .unit = "rad"})
            .field("periods", &LimitCycle::periods, only_answered(integer(0, 1 << 30)), "Whole steady periods used.",
                   {.required = true})
            .field("shift", &LimitCycle::shift, maybe(answer(shifted_point_contract())),
                   "The response at the same frequency, shifted into the right half-plane.")
            .field("fit_rms", &LimitCycle::fit_rms, only_answered(maybe(number())),
                   "Root mean square of model minus record over the steady periods (Eq. 15).", {.unit = "y"})
            .field("describing_function", &LimitCycle::describing_function, maybe(object(ultimate_point_contract())),
                   "Ultimate point by the describing function: an approximation; the model's is better.")
            .field("t_plus", &LimitCycle::t_plus, only_answered(maybe(number())),
                   "Time of u at its upper level in each period.", {.unit = "time"})
            .field("t_minus", &LimitCycle::t_minus, only_answered(maybe(number())),
                   "Time of u at its lower level in each period.", {.unit = "time"})
            .field("y_max", &LimitCycle::y_max, only_answered(maybe(number())), "Largest y of the oscillation.",
                   {.unit = "y"})
            .field("y_min", &LimitCycle::y_min, only_answered(maybe(number())), "Smallest y of the oscillation.",
                   {.unit = "y"});
        return d;
    }();
    return description;
}

const Description<FrequencyPoint>& frequency_point_contract() {
    static const auto description = [] {
        Description<FrequencyPoint> d("FrequencyPoint", "A measured value of the plant's frequency response.");
        d.field("omega", &FrequencyPoint::omega, only_answered(number()), "Angular frequency.", {.unit = "rad/time"})
            .field("re", &FrequencyPoint::re, only_answered(number()), "Real part.", {.unit = "y/u"})
            .field("im", &FrequencyPoint::im, only_answered(number()), "Imaginary part.", {.unit = "y/u"})
            .field("std", &FrequencyPoint::std, only_answered(number()), "Standard deviation of each part.",
                   {.unit = "y/u"});
        return d;
    }();
    return description;
}

namespace {

const Description<RelaySettings>& relay_settings_contract() {
    static const auto description = [] {
        Description<RelaySettings> d("Relay",
                                     "u_plus from t = 0 at rest; to u_minus when y > hysteresis, to u_plus when y < "
                                     "-hysteresis; the other way round if the plant's gain is negative.");
        d.field("u_plus", &RelaySettings::u_plus, number(), "Upper level, from the operating point; > u_minus.",
                {.unit = "u"})
            .field("u_minus", &RelaySettings::u_minus, number(), "Lower level, from the operating point.",
                   {.unit = "u"})
            .field("hysteresis", &RelaySettings::hysteresis, number({.minimum = 0}),
                   "The relay switches when |y| exceeds it.", {.unit = "y"})
            .field("noise_std", &RelaySettings::noise_std, number({.minimum = 0}),
                   "Standard deviation of white noise on each sample, seen by the relay; needs relay_sample_time > 0.",
                   {.unit = "y"})
            .field("relay_sample_time", &RelaySettings::relay_sample_time, number({.minimum = 0}),
                   "Sample time of the relay; 0: it switches at the instant of the crossing.", {.unit = "time"})
            .field(
                "record_interval", &RelaySettings::record_interval, maybe(number({.exclusive_minimum = 0})),
                "Spacing of the record's rows, a whole multiple of relay_sample_time; Pu/200 or relay_sample_time if "
                "not given. Every switch is a row, too.",
                {.unit = "time"})
            .field("cycles", &RelaySettings::cycles, integer(1, kMaxRelayCycles), "Cycles recorded from t = 0.")
            .field("seed", &RelaySettings::seed, integer(0, 2147483647),
                   "Seed of the noise: equal seeds give equal records.")
            .field("shift", &RelaySettings::shift, maybe(number({.exclusive_minimum = 0})),
                   "Value of limit_cycle.shift; default: 1/Pu.", {.unit = "1/time"});
        return d;
    }();
    return description;
}

void check_relay(const Json&, RelayRequest& request, Reader& reader) {
    const auto plant = LinearPlant::make(*request.plant);
    if (!plant) reader.fault_below(plant.error().where, 0, plant.error().message);
    if (const auto error = refuse_settings(request.relay)) reader.fault_below(error->where, 0, error->message);
}

Codec<std::vector<double>> column() { return only_answered(numbers(0, kMaxRelayRows)); }

const Description<RelayRecord>& relay_record_contract() {
    static const auto description = [] {
        const auto zero = [](const RelayRecord&, Writer& out) { out.integer(0); };
        const auto zero_schema = [](SchemaBook&) { return Json{{"type", "number"}, {"const", 0}}; };
        Description<RelayRecord> d("RelayRecord",
                                   "The simulated test, in the form of a record for /v1/identify. u holds from "
                                   "its row to the next.");
        d.tag("kind", "relay")
            .field("t", &RelayRecord::t, column(), "Times.", {.unit = "time"})
            .field("u", &RelayRecord::u, column(), "Relay output.", {.unit = "u"})
            .field("y", &RelayRecord::y, column(), "Measurement, noise included.", {.unit = "y"})
            .field("u0", {}, zero, zero_schema, "u before the first row.", {.unit = "u"})
            .field("y0", {}, zero, zero_schema, "y before the first row.", {.unit = "y"});
        return d;
    }();
    return description;
}

const Description<RelayPlan>& relay_plan_contract() {
    static const auto description = [] {
        Description<RelayPlan> d("RelayPlan", "The relay test recommended on this plant.");
        d.field("u_plus", &RelayPlan::u_plus, only_answered(number()), "Upper level.", {.unit = "u"})
            .field("u_minus", &RelayPlan::u_minus, only_answered(number()), "Lower level.", {.unit = "u"})
            .field("hysteresis", &RelayPlan::hysteresis, only_answered(number()),
                   "3 noise_std, or without noise as given.", {.unit = "y"})
            .field("amplitude", &RelayPlan::amplitude, only_answered(number()), "Expected amplitude of y.",
                   {.unit = "y"})
            .field("expected_period", &RelayPlan::expected_period, only_answered(number()), "Period to expect.",
                   {.unit = "time"})
            .field("cycles", &RelayPlan::cycles, only_answered(integer(1, kMaxRelayCycles)),
                   "Number of cycles, including those for settling.")
            .field("duration", &RelayPlan::duration, only_answered(number()), "Approximate duration.", {.unit = "time"})
            .field("record_interval", &RelayPlan::record_interval, only_answered(number()),
                   "Spacing of the rows: 200 per period, or every sample of the relay.", {.unit = "time"})
            .field("reason", &RelayPlan::reason, only_answered(text(1000)), "Reason for these values.");
        return d;
    }();
    return description;
}

}  // namespace

const Description<RelayRequest>& relay_request_contract() {
    static const auto description = [] {
        Description<RelayRequest> d("RelayRequest", "A plant and the relay test to simulate on it.");
        d.field("name", &RelayRequest::name, maybe(text(kMaxNameLength)), "A label, such as the loop's tag.")
            .field("units", &RelayRequest::units, maybe(object(units_contract())), "Labels of the units.")
            .field("plant", &RelayRequest::plant, maybe(plant_or_text()), "The plant.", {.required = true})
            .field("relay", &RelayRequest::relay, object(relay_settings_contract()), "The relay and the record.")
            .check(check_relay)
            .example({{"plant", {{"type", "fopdt"}, {"K", 1}, {"T", 10}, {"L", 2}}},
                      {"relay", {{"u_plus", 1.3}, {"u_minus", -0.7}, {"hysteresis", 0.2}, {"cycles", 6}}}});
        return d;
    }();
    return description;
}

const Description<RelayExperiment>& relay_answer_contract() {
    static const auto description = [] {
        Description<RelayExperiment> d("RelayAnswer", "The result of the relay test.");
        d.field("record", &RelayExperiment::record, answer(relay_record_contract()), "The test from rest.")
            .field("limit_cycle", &RelayExperiment::limit_cycle, answer(limit_cycle_contract()),
                   "The steady oscillation without noise, as a fixed point; Au, phi_u and shift are the plant's own.")
            .field("reversed", &RelayExperiment::reversed, only_answered(boolean()),
                   "True if the relay acts on -y, because the plant's gain is negative.")
            .field("plan", &RelayExperiment::plan, answer(relay_plan_contract()), "The recommended test.")
            .field("warnings", &RelayExperiment::warnings, list_of(answer(warning_contract())), "Remarks.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
