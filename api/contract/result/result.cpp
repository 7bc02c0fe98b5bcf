#include "api/contract/result/result.h"

#include "api/contract/controller.h"
#include "api/contract/device/device.h"
#include "api/contract/methods.h"
#include "api/contract/plant/plant.h"
#include "api/contract/product/conversion.h"
#include "api/contract/product/product.h"
#include "api/contract/reports/reports.h"
#include "api/contract/result/evaluation.h"
#include "api/contract/result/identified_model.h"

namespace tunewright::api {

const Description<verdict::Finding>& finding_contract() {
    static const auto description = [] {
        using F = verdict::Finding;
        using enum verdict::Level;
        Description<F> d("Finding",
                         "A conclusion from the figures of this answer, as an engineer would say it: a code for "
                         "programs, a sentence for people. docs/verdicts.md lists them.");
        d.field("code", &F::code, words(), "Stable, in kebab-case.")
            .field("level", &F::level,
                   only_answered(
                       choice<verdict::Level>({{"good", good}, {"note", note}, {"warning", warning}, {"bad", bad}})),
                   "bad: what it belongs to is not to be used as it stands.")
            .field("text", &F::text, words(),
                   "One or two sentences in the request's units; numbers with three significant digits.")
            .field("figures", &F::figures,
                   numbers_by_name("Every number of the text under its name, in full precision."),
                   "The numbers that the sentence is about.");
        return d;
    }();
    return description;
}

namespace {

Json whole_number(SchemaBook&) { return {{"type", "integer"}}; }

// Reads a member of the entry's evaluation; left out where there is none.
template <class M>
void evaluation_field(Description<TuningEntry>& d, const char* name, M Evaluation::*member, const Codec<M>& codec,
                      const char* sentence) {
    d.field(
        name, {},
        [member, codec](const TuningEntry& entry, Writer& out) { codec.write((*entry.evaluation).*member, out); },
        codec.schema, sentence, {},
        [member, codec](const TuningEntry& entry) {
            return !entry.evaluation || (codec.skip && codec.skip((*entry.evaluation).*member));
        });
}

// One of the entry's reports; left out where there is none of this kind.
void report_field(Description<TuningEntry>& d, const ReportContract& contract) {
    const auto find = [is = contract.is](const TuningEntry& entry) -> const MethodReport* {
        for (const auto& report : entry.reports)
            if (is(*report)) return report.get();
        return nullptr;
    };
    d.field(
        contract.field, {},
        [find, write = contract.write](const TuningEntry& entry, Writer& out) { write(*find(entry), out); },
        contract.schema, contract.sentence, {}, [find](const TuningEntry& entry) { return find(entry) == nullptr; });
}

void add_reports(Description<TuningEntry>& d, bool last) {
    for (const ReportContract& report : report_contracts())
        if (report.last == last) report_field(d, report);
}

const Description<OptimumAtMs>& optimum_contract() {
    static const auto description = [] {
        using O = OptimumAtMs;
        Description<O> d("OptimumAtMs", "The least load IAE that a robust PID reaches with this entry's Ms as limit.");
        d.field("IAE", &O::IAE, figure(), "Load IAE of the method robust with both Ms and Mt limited to this Ms.",
                {.unit = "y time"})
            .field("excess_percent", &O::excess_percent, figure(),
                   "How far this entry's load IAE lies above it; below 0 where its filter or its Mt lets it.",
                   {.unit = "%"})
            .why_null("Not known for this entry.");
        return d;
    }();
    return description;
}

const Description<Standing>& standing_contract() {
    static const auto description = [] {
        using S = Standing;
        Description<S> d("Standing", "How an entry stands among the others: what ranking goes by.");
        using enum StandingGroup;
        d.field("group", &S::group,
                only_answered(choice<StandingGroup>({{"holds", holds},
                                                     {"above_limit", above_limit},
                                                     {"not_settled", not_settled},
                                                     {"unstable", unstable}})),
                "Groups rank in this order. above_limit: it settles, with a larger Ms than was asked of it or of all; "
                "not_settled: it is stable, but a response does not come to rest where it should.")
            .field("settles", &S::settles, boolean(),
                   "Stable, and both responses come to rest where they should; on a nonlinear plant its own responses.")
            .field("Ms", &S::Ms, figure(),
                   "Of the loop as it will run: on the worst plant that it must serve, in the user's own controller.")
            .field("within", &S::within, boolean(),
                   "The limit on Ms that was asked of this entry holds; true where none was.")
            .field(
                "excess_percent", &S::excess_percent, figure(),
                "How far the load IAE lies above the least that a PID reaches on the linear plant at the same Ms, or "
                "at the nearest Ms where there is an optimum; of a nonlinear plant its own load IAE.",
                {.unit = "%"})
            .field(
                "order", {}, [](const S& standing, Writer& out) { out.integer(standing.order); }, whole_number,
                "Place, from 1, where no limit on the Ms of all is set: by this order and least_limit a client ranks "
                "under another limit.")
            .field("least_limit", &S::min_limit, figure(),
                   "The least limit on the Ms of all with which the group is holds.")
            .field(
                "why", {}, [](const S& standing, Writer& out) { out.text(standing.why); }, words().schema,
                "Why it stands behind those that hold; left out where it holds.", {},
                [](const S& standing) { return standing.holds(); })
            .why_null("The loop is unstable, here or on some plant that it must serve.");
        return d;
    }();
    return description;
}

const Description<OperatingPoint>& operating_point_contract() {
    static const auto description = [] {
        Description<OperatingPoint> d("OperatingPoint",
                                      "The true steady state nearest to the values given; absolute values.");
        d.field(
             "states", {},
             [](const OperatingPoint& point, Writer& out) {
                 out.begin_object();
                 for (const NamedValue& state : point.states) {
                     out.key(state.name);
                     out.number(state.value);
                 }
                 out.end_object();
             },
             [](SchemaBook&) {
                 return Json{{"type", "object"}, {"additionalProperties", {{"type", "number"}}}};
             },
             "By name.")
            .field("u", &OperatingPoint::u, only_answered(number()), "The nominal input.", {.unit = "u"})
            .field("y", &OperatingPoint::y, only_answered(number()), "The output.", {.unit = "y"});
        return d;
    }();
    return description;
}

// The fields operating_point and linear_model of an answer; left out where `of` gives null.
template <class Answer>
void add_operating_point(Description<Answer>& d, Callable<const OperatingPoint*(const Answer&)> of) {
    const auto none = [of](const Answer& answer) { return of(answer) == nullptr; };
    d.field(
         "operating_point", {},
         [of](const Answer& answer, Writer& out) { operating_point_contract().write(*of(answer), out); },
         [](SchemaBook& book) { return operating_point_contract().schema(book); },
         "Of a nonlinear plant: the steady state that everything is a deviation from.", {}, none)
        .field(
            "linear_model", {},
            [of](const Answer& answer, Writer& out) { plant_contract().write(of(answer)->linear_model, out); },
            [](SchemaBook& book) { return plant_contract().schema(book); },
            "Of a nonlinear plant: the linearisation there, on which methods and robustness rest.", {}, none);
}

constexpr const char* kWhichToTake =
    "Over all entries: which to take, against today's settings; the most important first.";

Json problem_reference(SchemaBook&) { return {{"$ref", "#/components/schemas/Problem"}}; }

const OperatingPoint* pointer(const std::optional<OperatingPoint>& point) { return point ? &*point : nullptr; }

bool no_method(const TuningEntry& entry) { return entry.method.empty(); }

void add_method_fields(Description<TuningEntry>& d) {
    const auto word = [](SchemaBook&) { return Json{{"type", "string"}}; };
    d.field(
         "method", {}, [](const TuningEntry& entry, Writer& out) { out.text(entry.method); }, word,
         "Id of the method; baseline for today's settings.", {}, no_method)
        .field(
            "title", {}, [](const TuningEntry& entry, Writer& out) { out.text(entry.title); }, word, "Its name.", {},
            no_method)
        .field(
            "source", {}, [](const TuningEntry& entry, Writer& out) { out.text(entry.source); }, word,
            "Where it was published.", {}, [](const TuningEntry& entry) { return entry.source.empty(); })
        .field(
            "options", {},
            [](const TuningEntry& entry, Writer& out) { write_options(entry.method, entry.options, out); },
            [](SchemaBook&) {
                return Json{{"type", "object"}, {"additionalProperties", true}};
            },
            "Options given, over the defaults.", {},
            [](const TuningEntry& entry) { return entry.method.empty() || entry.method == "baseline"; });
}

void add_device_entry(Description<TuningEntry>& d) {
    const auto none = [](const TuningEntry& entry) { return !entry.on_device; };
    d.field(
         "longest_sample_time", {},
         [](const TuningEntry& entry, Writer& out) {
             *entry.longest_sample_time ? out.number(**entry.longest_sample_time) : out.null();
         },
         [](SchemaBook&) {
             return Json{{"type", {"number", "null"}}};
         },
         "The longest sample time of a program with backward rules that keeps Ms within 5 % of the continuous loop's; "
         "null: none was found. Only of designs.",
         {.unit = "time"}, [](const TuningEntry& entry) { return !entry.longest_sample_time; })
        .field(
            "as_entered", {},
            [](const TuningEntry& entry, Writer& out) {
                const device::Fitted& f = entry.on_device->fitted;
                settings_answer_contract().write({f.product, f.settings, f.typed, f.controller, f.notes}, out);
            },
            [](SchemaBook& book) { return settings_answer_contract().schema(book); },
            "With implement.product: what to type into the product.", {},
            [](const TuningEntry& entry) { return !entry.on_device || entry.on_device->fitted.typed.empty(); })
        .field(
            "implemented", {},
            [](const TuningEntry& entry, Writer& out) { implemented_contract().write(*entry.on_device, out); },
            [](SchemaBook& book) { return implemented_contract().schema(book); },
            "With implement: the loop as the user's controller computes it.", {}, none);
}

Codec<std::vector<verdict::Finding>> findings() { return list_of(answer(finding_contract())); }

const Description<TuningEntry>& entry_contract() {
    static const auto description = [] {
        Description<TuningEntry> d("Entry", "One controller with everything known about it, or why there is none.");
        add_method_fields(d);
        d.field(
            "over_region", {}, [](const TuningEntry&, Writer& out) { out.boolean(true); },
            [](SchemaBook&) {
                return Json{{"type", "boolean"}};
            },
            "Limits hold over the record's 95 % confidence region; left out where they hold on the model alone.", {},
            [](const TuningEntry& entry) { return !entry.over_region; });
        d.field(
            "region_cost", {}, [](const TuningEntry& entry, Writer& out) { out.number(*entry.region_cost); },
            [](SchemaBook&) {
                return Json{{"type", "number"}};
            },
            "Beside over_region: the load IAE over that of the design on the model alone.", {},
            [](const TuningEntry& entry) { return !entry.region_cost; });
        d.field("verdict", &TuningEntry::verdict, findings(),
                "What the figures mean, the most important first. The first finding says what the loop is; its level "
                "is the entry's.");
        evaluation_field(d, "warnings", &Evaluation::warnings, list_of(answer(warning_contract())), "Remarks.");
        d.field("reduced_model", &TuningEntry::reduced_model, maybe(only_answered(one_of(plant_contract()))),
                "The simpler model that the rule used.");
        d.field(
            "controller", {},
            [](const TuningEntry& entry, Writer& out) {
                controller_contract().write(entry.unjudged ? *entry.unjudged : entry.evaluation->controller, out);
            },
            one_of(controller_contract()).schema,
            "The controller. Of a request with ultimate it stands without the figures of a loop.", {},
            [](const TuningEntry& entry) { return !entry.unjudged && !entry.evaluation; });
        evaluation_field(d, "equivalents", &Evaluation::equivalents, object(equivalents_contract()),
                         "The same loop in other forms.");
        evaluation_field(d, "robustness", &Evaluation::robustness, object(robustness_contract()), "Peaks and margins.");
        evaluation_field(d, "nonlinear", &Evaluation::nonlinear, maybe(answer(nonlinear_contract())),
                         "Of the form npid: whether errors of every size die out.");
        evaluation_field(d, "performance", &Evaluation::performance, object(performance_contract()),
                         "Figures of the responses.");
        evaluation_field(d, "responses", &Evaluation::responses, maybe(answer(responses_contract())),
                         "Traces over time; left out with points 0 and for unstable loops.");
        evaluation_field(d, "linear", &Evaluation::linear, maybe(answer(linear_contract())),
                         "Of a nonlinear plant, whose own performance and responses are above: its linearisation's.");
        evaluation_field(d, "frequency", &Evaluation::frequency, maybe(answer(frequency_contract())),
                         "Traces over frequency; left out with points 0.");
        evaluation_field(d, "verification", &Evaluation::verification, object(verification_contract()),
                         "How the figures were checked.");
        evaluation_field(d, "region", &Evaluation::region, maybe(answer(region_contract())),
                         "On every plant that the controller must serve; left out where that is one.");
        add_device_entry(d);
        add_reports(d, false);
        d.field("optimum_at_Ms", &TuningEntry::optimum_at_Ms, maybe(answer(optimum_contract())),
                "Beside the least load IAE that a PID reaches at the same Ms, where asked for.")
            .field("standing", &TuningEntry::standing, maybe(answer(standing_contract())),
                   "How it stands among the others.");
        add_reports(d, true);
        evaluation_field(d, "compute_ms", &Evaluation::compute_ms, number(), "Time that this entry took, ms.");
        d.field(
            "error", {}, [](const TuningEntry& entry, Writer& out) { out.raw(to_json(to_problem(*entry.error))); },
            problem_reference, "Why the method has no controller.", {},
            [](const TuningEntry& entry) { return !entry.error; });
        return d;
    }();
    return description;
}

// The fields rank_limits and proposed of an answer.
template <class Answer, class Of>
void add_choice(Description<Answer>& d, Of of) {
    d.field(
         "rank_limits", {},
         [of](const Answer& answer, Writer& out) {
             out.begin_object();
             out.key("Ms");
             out.number(*of(answer).rank_Ms);
             out.end_object();
         },
         [](SchemaBook&) {
             return Json{{"type", "object"}, {"properties", {{"Ms", {{"type", "number"}}}}}, {"required", {"Ms"}}};
         },
         "The limits that `standing` and the ranking go by: those of the request, or their defaults. Left out where "
         "nothing ranks the entries.",
         {}, [of](const Answer& answer) { return !of(answer).rank_Ms; })
        .field(
            "proposed", {}, [of](const Answer& answer, Writer& out) { out.integer(*of(answer).proposed); },
            whole_number,
            "Index of the entry to show first: the one that the verdict says to take, or that comes nearest to today's "
            "settings; else the first that has a controller.",
            {}, [of](const Answer& answer) { return !of(answer).proposed; });
}

// The fields of an answer that say how its entries are ranked.
template <class Answer>
void add_ranking(Description<Answer>& d, Callable<const TuningResult&(const Answer&)> of) {
    d.field(
         "ranking", {},
         [of](const Answer& answer, Writer& out) {
             out.begin_array();
             for (const int index : of(answer).ranking) out.integer(index);
             out.end_array();
         },
         [](SchemaBook&) {
             return Json{{"type", "array"}, {"items", {{"type", "integer"}}}};
         },
         "Indices into controllers, best first; entries without a controller are left out.")
        .field(
            "ranking_by", {}, [of](const Answer& answer, Writer& out) { out.text(of(answer).ranking_by); },
            words().schema, "What they are ranked by.");
    add_choice<Answer>(d, of);
}

}  // namespace

const Description<ResultAnswer>& result_contract() {
    static const auto description = [] {
        Description<ResultAnswer> d("TuningResult", "The answer to a tuning request.");
        const auto none = FieldOptions{};
        d.field("units", &ResultAnswer::units, only_answered(maybe(object(units_contract()))), "As sent.")
            .field(
                "model", {}, [](const ResultAnswer& a, Writer& out) { model_contract().write(*a.result.model, out); },
                [](SchemaBook& book) { return model_contract().schema(book); }, "Of a record.", none,
                [](const ResultAnswer& a) { return !a.result.model; });
        add_operating_point<ResultAnswer>(d, [](const ResultAnswer& a) { return pointer(a.result.operating_point); });
        d.field(
             "controllers", {},
             [](const ResultAnswer& a, Writer& out) {
                 list_of(answer(entry_contract())).write(a.result.controllers, out);
             },
             list_of(answer(entry_contract())).schema, "One entry a method, in the order asked for; the baseline last.")
            .field(
                "verdict", {}, [](const ResultAnswer& a, Writer& out) { findings().write(a.result.verdict, out); },
                findings().schema, kWhichToTake);
        add_ranking<ResultAnswer>(d, [](const ResultAnswer& a) -> const TuningResult& { return a.result; });
        d.field(
             "partial", {}, [](const ResultAnswer& a, Writer& out) { out.boolean(a.result.partial); }, boolean().schema,
             "True: cancelled after a feasible design was found; this is the best so far.")
            .field(
                "version", {}, [](const ResultAnswer&, Writer& out) { out.text(TUNEWRIGHT_VERSION); }, words().schema,
                "Of the service.")
            .field("request_hash", &ResultAnswer::request_hash, words(),
                   "SHA-256 of the request in its canonical spelling.")
            .field(
                "seed", {}, [](const ResultAnswer&, Writer& out) { out.integer(0); }, whole_number,
                "Of random numbers; no method of this version uses any.");
        return d;
    }();
    return description;
}

const Description<TuningResult>& design_answer_contract() {
    static const auto description = [] {
        using R = TuningResult;
        Description<R> d("DesignAnswer", "What a job's result has, without what names and dates it.");
        d.field("model", &R::model, maybe(answer(model_contract())), "Of a record; left out where it was sent.");
        add_operating_point<R>(d, [](const R& a) { return pointer(a.operating_point); });
        d.field("controllers", &R::controllers, list_of(answer(entry_contract())),
                "One entry a method, in the order asked for; the baseline last.")
            .field("verdict", &R::verdict, findings(), kWhichToTake);
        add_ranking<R>(d, [](const R& a) -> const TuningResult& { return a; });
        return d;
    }();
    return description;
}

const Description<EvaluationResult>& evaluate_answer_contract() {
    static const auto description = [] {
        Description<EvaluationResult> d("EvaluateAnswer", "The controllers in the order sent.");
        add_operating_point<EvaluationResult>(d, [](const EvaluationResult& a) { return pointer(a.operating_point); });
        d.field("controllers", &EvaluationResult::controllers, list_of(answer(entry_contract())),
                "One entry a controller.")
            .field("verdict", &EvaluationResult::verdict, findings(), kWhichToTake);
        add_choice(d, [](const EvaluationResult& a) -> const EvaluationResult& { return a; });
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
