
#include "api/contract/range/range_experiments.h"

#include "api/contract/plant/typed.h"

namespace tunewright::api {
namespace {

const Description<range::ExperimentOptions>& range_experiment_contract() {
    static const auto description = [] {
        using O = range::ExperimentOptions;
        using enum range::ExperimentKind;
        Description<O> d("RangeExperiment", "The same test at each place, from its steady state.");
        d.field("kind", &O::kind, choice<range::ExperimentKind>({{"step", step}, {"relay", relay}}), "Kind of test.")
            .field("at", &O::at, numbers(1, range::kMaxPoints), "The places, ascending, inside the range.",
                   {.required = true})
            .field("size", &O::size, maybe(number({.not_zero = true})),
                   "Size of the step of u, or half of the relay's amplitude; default: from y_part at each place.",
                   {.unit = "u"})
            .field("y_part", &O::y_part, number({.exclusive_minimum = 0, .maximum = 1}),
                   "Without size: y moves by about this fraction of its change over the range.")
            .field(
                "hysteresis_part", &O::hysteresis_part, number({.minimum = 0, .maximum = 1}),
                "Hysteresis of the relay, as a fraction of that motion of y; required for a plant without dead time.");
        return d;
    }();
    return description;
}

/// The record of a test of any kind.
struct TestRecord {
    const char* kind;
    const std::vector<double>*t, *u, *y;
};

TestRecord record_in(const range::PlaceTest& place) {
    if (const auto* step = std::get_if<StepTest>(&place.test)) return {"step", &step->t, &step->u, &step->y};
    const RelayRecord& relay = std::get<NonlinearRelayTest>(place.test).record;
    return {"relay", &relay.t, &relay.u, &relay.y};
}

void write_test_record(const range::PlaceTest& place, Writer& out) {
    const TestRecord record = record_in(place);
    out.begin_object();
    out.key("kind").text(record.kind);
    out.key("t").times(*record.t);
    out.key("u").trace(*record.u);
    out.key("y").trace(*record.y);
    out.key("u0").integer(0);
    out.key("y0").integer(0);
    out.end_object();
}

Json test_record_schema(SchemaBook&) {
    const Json column{{"type", "array"}, {"items", {{"type", {"number", "null"}}}}}, zero{{"type", "number"}};
    return {{"type", "object"},
            {"properties",
             {{"kind", {{"type", "string"}, {"enum", {"step", "relay"}}}},
              {"t", column},
              {"u", column},
              {"y", column},
              {"u0", zero},
              {"y0", zero}}},
            {"required", {"kind", "t", "u", "y", "u0", "y0"}}};
}

const NonlinearRelayTest* relay_of(const range::PlaceTest& place) {
    return std::get_if<NonlinearRelayTest>(&place.test);
}

const Description<range::PlaceTest>& place_test_contract() {
    static const auto description = [] {
        using P = range::PlaceTest;
        const auto number_word = number().schema;
        const auto no_relay = [](const P& p) { return relay_of(p) == nullptr; };
        Description<P> d("RangeTest", "The test at one place.");
        d.field(
             "at", {}, [](const P& p, Writer& out) { out.number(p.rest.at); }, number_word, "The place.")
            .field("u", {}, [](const P& p, Writer& out) { out.number(p.rest.u); }, number_word,
                   "The steady input there, absolute.", {.unit = "u"})
            .field("y", {}, [](const P& p, Writer& out) { out.number(p.rest.y); }, number_word,
                   "The steady output there, absolute.", {.unit = "y"})
            .field("size", &P::size, only_answered(number()), "Size of the move of u, as used.", {.unit = "u"})
            .field("record", {}, write_test_record, test_record_schema,
                   "The test in deviations from the steady state, in the form of a point's record.")
            .field(
                "Pu", {}, [](const P& p, Writer& out) { out.number(relay_of(p)->Pu); }, number_word,
                "For a relay test: the period.", {.unit = "time"}, no_relay)
            .field(
                "Ku", {}, [](const P& p, Writer& out) { out.number(relay_of(p)->Ku); }, number_word,
                "For a relay test: the ultimate gain by the describing function.", {.unit = "u/y"}, no_relay);
        return d;
    }();
    return description;
}

}  // namespace

const Description<RangeExperimentsRequest>& range_experiments_contract() {
    static const auto description = [] {
        using R = RangeExperimentsRequest;
        Description<R> d("RangeExperimentsRequest", "Equations, their range, and the tests to simulate in it.");
        add_labels(d);
        d.field("plant", &R::plant, maybe(plant_model_or_text()), "The equations.", {.required = true})
            .field("range", &R::way, maybe(object(way_contract())), "Path through their steady states.",
                   {.required = true})
            .field("experiment", &R::experiment, object(range_experiment_contract()), "The tests.", {.required = true})
            .check([](const Json&, R& request, Reader& reader) { follow_way(request, reader); });
        return d;
    }();
    return description;
}

const Description<RangeExperiments>& range_experiments_answer_contract() {
    static const auto description = [] {
        using A = RangeExperiments;
        Description<A> d("RangeExperiments", "A test at each place.");
        d.field(
             "scheduling", {},
             [](const A& a, Writer& out) {
                 out.begin_object();
                 out.key("name").text(a.branch->scheduling_name());
                 out.key("from").number(a.branch->low());
                 out.key("to").number(a.branch->high());
                 out.end_object();
             },
             [](SchemaBook&) {
                 const Json number{{"type", "number"}};
                 return Json{{"type", "object"},
                             {"properties", {{"name", {{"type", "string"}}}, {"from", number}, {"to", number}}},
                             {"required", {"name", "from", "to"}}};
             },
             "Quantity along which the equations were followed.")
            .field("tests", &A::tests, list_of(answer(place_test_contract())), "In the order of `at`.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
