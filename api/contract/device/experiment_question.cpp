#include "api/contract/device/experiment_question.h"

#include "api/contract/device/code_question.h"

namespace tunewright::api {
namespace {

using code::Action;
using code::Experiment;
using Q = ExperimentQuestion;

constexpr NumberRule kNotNegative{.minimum = 0};

void add_sizes(Description<Q>& d) {
    d.field("u_step", &Q::u_step, number({.not_zero = true}),
            "Size of the moves of u: of a relay test to either side and above 0, of a bump with its sign.",
            {.required = true, .unit = "u"})
        .field(
            "asymmetry", &Q::asymmetry,
            number({.minimum = -code::kLargestAsymmetry, .maximum = code::kLargestAsymmetry}),
            "Relay: the levels are u0 + u_step (1 + asymmetry) and u0 - u_step (1 - asymmetry); unequal ones show the "
            "static gain too.")
        .field("cycles", &Q::cycles, integer(0, code::kMostCycles),
               "Relay: exactly so many; 0: until the cycle is steady.")
        .field("action", &Q::action,
               choice<Action>({{"find", Action::find}, {"reverse", Action::reverse}, {"direct", Action::direct}}),
               "Relay: how the loop's controller acts. reverse: u falls when y rises; find: from the first move, not "
               "for a "
               "plant that is unstable or first moves the wrong way.")
        .field(
            "y_move", &Q::y_move, number(kNotNegative),
            "Bump: ends the step when y has moved so far, needed for a plant that integrates; 0: when y has settled.",
            {.unit = "y"})
        .field("hysteresis", &Q::hysteresis, number(kNotNegative),
               "Least distance of y from its level at which u moves; the noise may demand more.", {.unit = "y"});
}

void add_limits(Description<Q>& d) {
    d.field("u_min", &Q::u_min, maybe(number()), "Least u.", {.unit = "u"})
        .field("u_max", &Q::u_max, maybe(number()), "Largest u.", {.unit = "u"})
        .field("y_min", &Q::y_min, maybe(number()), "y below it stops the test.", {.unit = "y"})
        .field("y_max", &Q::y_max, maybe(number()), "y above it stops the test.", {.unit = "y"})
        .field("u_safe", &Q::u_safe, maybe(number()), "u after a fault; without it u as before the test.",
               {.unit = "u"})
        .field("rate_limit", &Q::rate_limit, number(kNotNegative),
               "Largest change of u per second, faults excepted; 0: no limit.", {.unit = "u/s"})
        .field("quiet_time", &Q::quiet_time, number(kNotNegative),
               "Time in which u is held and the noise measured; 0: 30 calls.", {.unit = "s"})
        .field("max_time", &Q::max_time, number(kNotNegative), "Longest test; 0: 5000 calls.", {.unit = "s"})
        .field("frozen_time", &Q::frozen_time, number(kNotNegative),
               "y unchanged for longer is a fault; 0: found from the quiet time.", {.unit = "s"});
}

void refuse_others(const Json& value, Experiment experiment, Reader& reader) {
    const bool relay = experiment == Experiment::relay;
    const auto refuse = [&](const char* name) {
        if (value.contains(name))
            reader.fault_at(
                name, std::string(name) + " belongs to " + (relay ? "a bump" : "a relay test") + ". Leave it out.");
    };
    if (relay) return refuse("y_move");
    for (const char* name : {"asymmetry", "cycles", "action"}) refuse(name);
}

}  // namespace

const Description<ExperimentQuestion>& experiment_contract() {
    static const auto description = [] {
        Description<Q> d("ExperimentCodeRequest", "The program of a test that a controller runs by itself.");
        d.field("experiment", &Q::experiment,
                choice<Experiment>({{"relay", Experiment::relay}, {"bump", Experiment::bump}}),
                "relay: u switches as y crosses its level, until the cycle is steady; bump: a step of u and back.",
                {.required = true})
            .field("language", &Q::language, code_language(), "st, c, python or arduino.", {.required = true})
            .field("sample_time", &Q::Ts, number({.exclusive_minimum = 0}),
                   "Time from one call to the next; at most a tenth of the plant's dead time or of its time constant.",
                   {.required = true, .unit = "s"});
        add_sizes(d);
        add_limits(d);
        d.check([](const Json& value, Q& question, Reader& reader) {
            refuse_others(value, question.experiment, reader);
            const auto program = code::experiment_algorithm(question.experiment, question);
            if (!program) reader.fault_at(program.error().where, program.error().message);
        });
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
