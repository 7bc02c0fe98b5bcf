#include "api/contract/result/evaluation.h"

#include "api/contract/plant/plant.h"
#include "api/describe/answers.h"

namespace tunewright::api {
namespace {

constexpr const char* kNoFigure = "Infinite or not defined for this loop.";

using Tolerates = Robustness::Tolerates;

void write_why(const Figure& figure, Writer& out) { out.text(figure.why.empty() ? kNoFigure : figure.why); }

void write_figure(const Figure& figure, Writer& out) { figure ? out.number(*figure) : out.null(); }

// The tolerated changes of the plant are its margins: a missing one has the margin's reason.
void write_tolerates(const Robustness& robustness, Writer& out) {
    const Tolerates& tolerates = robustness.tolerates;
    out.begin_object();
    out.key("gain").begin_array();
    write_figure(tolerates.gain_low, out);
    write_figure(tolerates.gain_high, out);
    out.end_array();
    out.key("extra_dead_time");
    write_figure(tolerates.extra_dead_time, out);
    const bool gain = !tolerates.gain_low || !tolerates.gain_high, dead_time = !tolerates.extra_dead_time;
    if (gain || dead_time) {
        out.key("why_null").begin_object();
        if (gain) {
            out.key("gain");
            write_why(tolerates.gain_high ? tolerates.gain_low : tolerates.gain_high, out);
        }
        if (dead_time) {
            out.key("extra_dead_time");
            write_why(tolerates.extra_dead_time, out);
        }
        out.end_object();
    }
    out.end_object();
}

Json tolerates_schema(SchemaBook&) {
    const Json figure{{"type", {"number", "null"}}};
    Json gain{{"type", "array"},
              {"items", figure},
              {"minItems", 2},
              {"maxItems", 2},
              {"description", "Lowest and highest factor of the plant's gain."}};
    Json dead_time = figure;
    dead_time["description"] = "Additional dead time.";
    dead_time["x-unit"] = "time";
    return {{"type", "object"},
            {"properties",
             {{"gain", gain},
              {"extra_dead_time", dead_time},
              {"why_null", {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}}}}},
            {"required", {"gain", "extra_dead_time"}},
            {"additionalProperties", false}};
}

const Description<SetpointPerformance>& setpoint_contract() {
    static const auto description = [] {
        using P = SetpointPerformance;
        Description<P> d("SetpointPerformance", "Figures of the response to the set-point step.");
        d.field("IAE", &P::IAE, figure(), "Integral of |r - y|.", {.unit = "y time"})
            .field("ISE", &P::ISE, figure(), "Integral of (r - y)^2.", {.unit = "y^2 time"})
            .field("ITAE", &P::ITAE, figure(), "Integral of t |r - y|.", {.unit = "y time^2"})
            .field("overshoot_percent", &P::overshoot_percent, figure(),
                   "Overshoot of y over r, in percent of the step.", {.unit = "%"})
            .field("rise_time", &P::rise_time, figure(), "Time from 10 to 90 % of the step.", {.unit = "time"})
            .field("rise_time_5_95", &P::rise_time_5_95, figure(), "Time from 5 to 95 % of the step.", {.unit = "time"})
            .field("settling_time", &P::settling_time, figure(), "Last time outside 2 % of the step.", {.unit = "time"})
            .field("TV", &P::TV, figure(), "Total variation of u, including the jump at 0.", {.unit = "u"})
            .field("first_move", &P::first_move, figure(), "u(0+).", {.unit = "u"})
            .why_null(kNoFigure);
        return d;
    }();
    return description;
}

const Description<NoisePerformance>& noise_contract() {
    static const auto description = [] {
        using P = NoisePerformance;
        Description<P> d("NoisePerformance", "Effect of measurement noise on u.");
        d.field("u_std", &P::u_std, figure(), "Standard deviation of u.", {.unit = "u"})
            .field("gain", &P::gain, figure(), "Ratio of the standard deviations of u and the noise.", {.unit = "u/y"})
            .why_null(kNoFigure);
        return d;
    }();
    return description;
}

const Description<Trace>& trace_contract() {
    static const auto description = [] {
        Description<Trace> d("Trace", "A response, six significant digits.");
        d.field("t", &Trace::t, abscissa(), "Time from the step.", {.unit = "time"})
            .field("y", &Trace::y, trace(), "Measurement.", {.unit = "y"})
            .field("u", &Trace::u, trace(), "Controller output.", {.unit = "u"});
        return d;
    }();
    return description;
}

void write_loop_gain(const FrequencyTraces& traces, Writer& out) {
    out.begin_object();
    out.key("re").trace(traces.L_re);
    out.key("im").trace(traces.L_im);
    out.key("phase_deg").trace(traces.L_phase_deg);
    out.end_object();
}

Json loop_gain_schema(SchemaBook& book) {
    const Json column = trace().schema(book);
    return {{"type", "object"},
            {"properties", {{"re", column}, {"im", column}, {"phase_deg", column}}},
            {"required", {"re", "im", "phase_deg"}},
            {"additionalProperties", false}};
}

}  // namespace

const Description<Robustness>& robustness_contract() {
    static const auto description = [] {
        using R = Robustness;
        Description<R> d("Robustness", "Suprema over 0 <= omega <= infinity, and margins over all crossings.");
        d.field("stable", &R::stable, boolean(), "True if the closed loop is stable.")
            .field("Ms", &R::Ms, figure(), "Largest |S|, S = 1/(1 + P C).")
            .field("omega_Ms", &R::omega_Ms, figure(), "Frequency at which |S| is largest.", {.unit = "rad/time"})
            .field("Mt", &R::Mt, figure(), "Largest |T|, T = P C/(1 + P C).")
            .field("omega_Mt", &R::omega_Mt, figure(), "Frequency at which |T| is largest.", {.unit = "rad/time"})
            .field("Mks", &R::Mks, figure(), "Largest |C S|.", {.unit = "u/y"})
            .field("gain_margin", &R::gain_margin, figure(),
                   "Smallest factor > 1 of the gain at which the loop is unstable.")
            .field("gain_margin_low", &R::gain_margin_low, figure(),
                   "Largest factor < 1 of the gain at which the loop is unstable.")
            .field("phase_margin_deg", &R::phase_margin_deg, figure(),
                   "Smallest phase margin over all gain crossovers.", {.unit = "deg"})
            .field("delay_margin", &R::delay_margin, figure(), "Smallest delay margin over all gain crossovers.",
                   {.unit = "time"})
            .field("gain_crossover", &R::gain_crossover, figure(), "Frequency at which |P C| = 1.",
                   {.unit = "rad/time"})
            .field("phase_crossover", &R::phase_crossover, figure(),
                   "Frequency at which the phase of P C is -180 degrees.", {.unit = "rad/time"})
            .field(
                "binding", {}, [](const R& value, Writer& out) { out.text(value.binding); },
                [](SchemaBook&) {
                    return Json{{"type", "string"}};
                },
                "The limit that is active.", {}, [](const R& value) { return value.binding.empty(); })
            .field("tolerates", {}, write_tolerates, tolerates_schema,
                   "Model errors for which the loop remains stable, one at a time.")
            .why_null(kNoFigure);
        return d;
    }();
    return description;
}

const Description<LoadPerformance>& load_contract() {
    static const auto description = [] {
        using P = LoadPerformance;
        Description<P> d("LoadPerformance", "Figures of the response to the load step at the plant's input.");
        d.field("IAE", &P::IAE, figure(), "Integral of |y|.", {.unit = "y time"})
            .field("ISE", &P::ISE, figure(), "Integral of y^2.", {.unit = "y^2 time"})
            .field("ITAE", &P::ITAE, figure(), "Integral of t |y|.", {.unit = "y time^2"})
            .field("peak", &P::peak, figure(), "Largest deviation, signed.", {.unit = "y"})
            .field("recovery_time", &P::recovery_time, figure(), "Last time at which |y| exceeds 2 % of the peak.",
                   {.unit = "time"})
            .field("TV", &P::TV, figure(), "Total variation of u.", {.unit = "u"})
            .why_null(kNoFigure);
        return d;
    }();
    return description;
}

const Description<Performance>& performance_contract() {
    static const auto description = [] {
        Description<Performance> d("Performance",
                                   "Figures of the two step responses and, if noise was requested, of the noise.");
        d.field("setpoint", &Performance::setpoint, answer(setpoint_contract()), "Figures of the set-point step.")
            .field("load", &Performance::load, answer(load_contract()), "Figures of the load step.")
            .field("noise", &Performance::noise, maybe(answer(noise_contract())), "Figures of the measurement noise.");
        return d;
    }();
    return description;
}

const Description<Responses>& responses_contract() {
    static const auto description = [] {
        Description<Responses> d("Responses", "Both step responses, from t = 0 at the step.");
        d.field("setpoint", &Responses::setpoint, answer(trace_contract()), "Response to the set-point step.")
            .field("load", &Responses::load, answer(trace_contract()), "Response to the load step.")
            .field("settles", &Responses::settles, Codec<bool>{{}, boolean().write, boolean().schema},
                   "False: the horizon ends before the responses do.");
        return d;
    }();
    return description;
}

const Description<LinearisedResponse>& linear_contract() {
    static const auto description = [] {
        using R = LinearisedResponse;
        Description<R> d("StepResponse",
                         "The linearisation of a nonlinear plant with the same controller, steps and limits.");
        d.field("performance", &R::performance, answer(performance_contract()), "Figures of its responses.")
            .field("responses", &R::responses, maybe(answer(responses_contract())),
                   "Its traces; left out with points 0 and for unstable loops.");
        return d;
    }();
    return description;
}

const Description<FrequencyTraces>& frequency_contract() {
    static const auto description = [] {
        using F = FrequencyTraces;
        Description<F> d("Frequency", "The loop over frequency, six significant digits.");
        d.field("omega", &F::omega, abscissa(), "Angular frequency.", {.unit = "rad/time"})
            .field("L", {}, write_loop_gain, loop_gain_schema, "Loop gain P C; the phase is unwrapped.")
            .field("S_abs", &F::S_abs, trace(), "|S|.")
            .field("T_abs", &F::T_abs, trace(), "|T|.")
            .field("CS_abs", &F::CS_abs, trace(), "|C S|.", {.unit = "u/y"});
        return d;
    }();
    return description;
}

const Description<NonlinearFigures>& nonlinear_contract() {
    static const auto description = [] {
        using N = NonlinearFigures;
        const auto given = [](auto codec) {
            codec.read = {};
            return codec;
        };
        Description<N> d("Nonlinear",
                         "For the form npid with a stable linear part, whose integral has the input k e with k between "
                         "0 (large errors) and 1 (small ones): whether errors of every size die out.");
        d.field("delta_r", &N::delta_r, only_answered(number()), "delta_r as used.", {.unit = "y"})
            .field(
                "sector", {},
                [](const N&, Writer& out) {
                    out.begin_array();
                    out.integer(0);
                    out.integer(1);
                    out.end_array();
                },
                [](SchemaBook&) {
                    return Json{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
                },
                "Range of the gain k of the integral's input.")
            .field("stable_without_integral", &N::stable_without_integral, given(boolean()),
                   "True if the loop is stable with proportional and derivative action alone.")
            .field("circle_criterion", &N::circle_criterion, given(boolean()),
                   "True if Re G > -1 at all frequencies, G = (Ki/s) P/(1 + P C) with C without integral. Then every "
                   "error "
                   "dies out.")
            .field("popov_criterion", &N::popov_criterion, given(boolean()),
                   "True if Re (1 + j omega q) G > -1 for some q >= 0. The same conclusion, less conservative.")
            .field("popov_q", &N::popov_q, figure(), "Such a q.", {.unit = "time"})
            .field("limit_cycle_predicted", &N::limit_cycle_predicted, given(boolean()),
                   "Prediction of the describing function, an approximation: with an integral gain below 1 the loop "
                   "oscillates.")
            .field("limit_cycle_amplitude", &N::limit_cycle_amplitude, figure(),
                   "Amplitude of y; larger errors may grow.", {.unit = "y"})
            .field("limit_cycle_omega", &N::limit_cycle_omega, figure(), "Its frequency.", {.unit = "rad/time"})
            .field(
                "statement", {}, [](const N& value, Writer& out) { out.text(value.statement); },
                [](SchemaBook&) {
                    return Json{{"type", "string"}};
                },
                "The conclusion, in a sentence.")
            .why_null(kNoFigure);
        return d;
    }();
    return description;
}

const Description<IndexErrors>& index_errors_contract() {
    static const auto description = [] {
        using E = IndexErrors;
        Description<E> d("IndexErrors",
                         "Relative change of each index at the last halving of all time steps and their quadrature: "
                         "the remaining error is below it or 1e-6, whichever is larger.");
        d.field("IAE", &E::IAE, nullable_number(), "Promised: 1e-5 or less.")
            .field("ISE", &E::ISE, nullable_number(), "Promised: 1e-5 or less.")
            .field("ITAE", &E::ITAE, nullable_number(), "Promised: 2e-5 or less.")
            .field("TV", &E::TV, nullable_number(), "Promised: 5e-5 or less.")
            .why_null("The index has no value, or was checked in every step instead (on a nonlinear plant).");
        return d;
    }();
    return description;
}

const Description<Verification>& verification_contract() {
    static const auto description = [] {
        using V = Verification;
        Description<V> d("Verification", "Checks of the figures.");
        d.field("setpoint_errors", &V::setpoint_errors, answer(index_errors_contract()),
                "Errors of the indices of the set-point response.")
            .field("load_errors", &V::load_errors, answer(index_errors_contract()),
                   "Errors of the indices of the load response.")
            .field("iae_step_halving", &V::iae_step_halving, nullable_number(),
                   "Relative change of the load IAE when every time step is halved.")
            .field("load_error_keeps_sign", &V::load_error_keeps_sign, nullable_bool(),
                   "True if the error after the load step keeps its sign: its IAE is then exactly d Ti/Kp (in "
                   "magnitude), however slow the response is.")
            .field("ie_identity", &V::ie_identity, nullable_number(),
                   "Relative difference of the integral of y and d Ti/Kp.")
            .field("ms_grid_difference", &V::ms_grid_difference, nullable_number(),
                   "Relative difference of Ms on an independent grid.")
            .field("stability_methods_agree", &V::stability_methods_agree, nullable_bool(),
                   "True if two independent stability tests agree.")
            .why_null("This check does not apply to this loop.");
        return d;
    }();
    return description;
}

const Description<RegionFigures>& region_contract() {
    static const auto description = [] {
        using R = RegionFigures;
        Description<R> d("Region",
                         "The controller on all plants for which it is designed: a set, uncertainty ranges, or the 95 "
                         "% confidence region of a record.");
        d.field("stable_fraction", &R::stable_fraction, only_answered(number()),
                "Fraction of the plants (of the region's volume, by samples) whose loop is stable, 0 to 1; 1 only if "
                "no unstable one was found.")
            .field("worst_Ms", &R::worst_Ms, figure(), "Largest Ms of all evaluated plants.")
            .field("worst_plant", &R::worst_plant, only_answered(one_of(plant_contract())),
                   "The plant of that Ms, or one whose loop is unstable.")
            .why_null(kNoFigure);
        return d;
    }();
    return description;
}

const Description<Warning>& warning_contract() {
    static const auto description = [] {
        Description<Warning> d("Warning", "A remark: a code for programs, a sentence for people.");
        constexpr std::size_t kMaxCode = 100, kMaxDetail = 10'000;
        d.field("code", &Warning::code, text(kMaxCode), "The code, which does not change between versions; kebab-case.",
                {.required = true})
            .field("detail", &Warning::detail, text(kMaxDetail), "One sentence with the figures.", {.required = true})
            .field("level", &Warning::level,
                   choice<WarningLevel>({{"warning", WarningLevel::warning}, {"bad", WarningLevel::bad}}),
                   "bad: the entry or result must not be used in this form.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
