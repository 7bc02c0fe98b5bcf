#include "api/contract/request.h"

namespace tunewright::api {
namespace {

constexpr int kMaxPoints = 20'000;

Codec<int> points() {
    Codec<int> codec = integer(0, kMaxPoints);
    codec.read = [](const Json& value, int& target, Reader& reader) {
        const auto read = read_number(value, {}, reader);
        if (!read) return;
        if (*read != 0 && !(*read >= 2 && *read <= kMaxPoints && *read == static_cast<int>(*read))) {
            return reader.fault("points is " + shown(value) +
                                "; it must be 0 (no traces) or a whole number from 2 to 20000.");
        }
        target = static_cast<int>(*read);
    };
    codec.schema = [](SchemaBook&) {
        return Json{{"type", "integer"}, {"minimum", 0}, {"maximum", kMaxPoints}, {"not", {{"const", 1}}}};
    };
    return codec;
}

Codec<std::optional<double>> horizon() {
    Codec<std::optional<double>> codec;
    codec.read = [](const Json& value, std::optional<double>& target, Reader& reader) {
        if (value == "auto") {
            target.reset();
        } else if (value.is_string()) {
            reader.fault(wrong_kind(value, "a number > 0 or \"auto\"", reader));
        } else if (const auto read = read_number(value, {.exclusive_minimum = 0}, reader)) {
            target = *read;
        }
    };
    codec.write = [](const std::optional<double>& value, Writer& out) {
        value ? out.number(*value) : out.text("auto");
    };
    codec.schema = [](SchemaBook&) {
        return Json{{"oneOf", Json::array({Json{{"type", "string"}, {"const", "auto"}},
                                           Json{{"type", "number"}, {"exclusiveMinimum", 0}}})}};
    };
    return codec;
}

const Description<ActuatorLimits>& actuator_contract() {
    static const auto description = [] {
        Description<ActuatorLimits> d(
            "Actuator", "Limits of u, as deviations from the operating point; anti-windup is part of the simulation.");
        d.field("min", &ActuatorLimits::min, number({.maximum = 0}), "Lower limit, <= 0.",
                {.required = true, .unit = "u"})
            .field("max", &ActuatorLimits::max, number({.minimum = 0}), "Upper limit, >= 0 and > min.",
                   {.required = true, .unit = "u"})
            .check([](const Json&, ActuatorLimits& limits, Reader& reader) {
                if (!(limits.min < limits.max))
                    reader.fault_at("max", "max is " + full_digits(limits.max) + " and min " + full_digits(limits.min) +
                                               "; max must be > min.");
            });
        return d;
    }();
    return description;
}

const Description<NoiseOptions>& noise_contract() {
    static const auto description = [] {
        Description<NoiseOptions> d("Noise",
                                    "White measurement noise; it is reported apart and never enters IAE or TV.");
        d.field("std", &NoiseOptions::std, number({.minimum = 0}), "Standard deviation, >= 0.", {.unit = "y"})
            .field("sample_time", &NoiseOptions::sample_time, number({.minimum = 0}),
                   "Time between samples; 0: 1/100 of the shorter of the loop's own times.", {.unit = "time"});
        return d;
    }();
    return description;
}

}  // namespace

const Description<EvaluateOptions>& evaluate_options_contract() {
    static const auto description = [] {
        Description<EvaluateOptions> d("Evaluate", "What is simulated and how much of it is answered.");
        d.field("setpoint_step", &EvaluateOptions::setpoint_step, number({.not_zero = true}),
                "Size of the set-point step.", {.unit = "y"})
            .field("load_step", &EvaluateOptions::load_step, number({.not_zero = true}),
                   "Size of the load step at the plant's input.", {.unit = "u"})
            .field(
                "horizon", &EvaluateOptions::horizon, horizon(),
                "Length of the responses; a number also ends the indices, which are integrals to infinity with auto.",
                {.unit = "time"})
            .field("points", &EvaluateOptions::points, points(), "Points of each trace: 0 (no traces) or 2 to 20000.")
            .field("actuator", &EvaluateOptions::actuator, maybe(object(actuator_contract())), "Limits of u.")
            .field("noise", &EvaluateOptions::noise, maybe(object(noise_contract())), "Measurement noise.")
            .field("tradeoff", &EvaluateOptions::tradeoff, boolean(),
                   "Also tell each controller's trade-off between set points and loads.")
            .field(
                "rank_limits",
                [](const Json& value, EvaluateOptions& options, Reader& reader) {
                    if (!value.is_object())
                        return reader.fault(wrong_kind(value, "an object such as {\"Ms\": 2}", reader));
                    for (const auto& [name, member] : value.items()) {
                        const Reader::At at(reader, name);
                        if (name != "Ms") {
                            reader.fault(name + " is not a field here; known is Ms.");
                        } else if (const auto read = read_number(member, {.exclusive_minimum = 1}, reader)) {
                            options.rank_Ms = *read;
                        }
                    }
                },
                [](const EvaluateOptions& options, Writer& out) {
                    out.begin_object();
                    out.key("Ms");
                    out.number(options.rank_Ms);
                    out.end_object();
                },
                [](SchemaBook&) {
                    return Json{{"type", "object"},
                                {"properties", {{"Ms", {{"type", "number"}, {"exclusiveMinimum", 1}, {"default", 2}}}}},
                                {"additionalProperties", false}};
                },
                "Entries above these limits rank last.")
            .field("optimum_at_Ms", &EvaluateOptions::optimum_at_Ms, maybe(boolean()),
                   "Whether each entry is compared with the robust PID of the least load IAE at the same Ms. Default: "
                   "true where a job compares several methods, else false.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
