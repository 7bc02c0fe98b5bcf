#include "api/contract/result/result.h"

#include "api/contract/controller.h"
#include "api/contract/device/device.h"
#include "api/contract/methods.h"
#include "api/contract/own_step.h"
#include "api/contract/plant/plant.h"
#include "api/contract/product/conversion.h"
#include "api/contract/product/product.h"
#include "api/contract/reports/reports.h"
#include "api/contract/result/evaluation.h"
#include "api/contract/result/identified_model.h"
#include "api/contract/result/replay.h"

namespace tunewright::api {

const Description<verdict::Finding>& finding_contract() {
    static const auto description = [] {
        using F = verdict::Finding;
        using enum verdict::Level;
        Description<F> d("Finding",
                         "A conclusion from the figures of this answer: a code for programs, a sentence for people. "
                         "docs/verdicts.md lists them.");
        d.field("code", &F::code, words(), "The code, which does not change between versions; kebab-case.")
            .field("level", &F::level,
                   only_answered(
                       choice<verdict::Level>({{"good", good}, {"note", note}, {"warning", warning}, {"bad", bad}})),
                   "bad: the entry or result must not be used in this form.")
            .field("text", &F::text, words(),
                   "One or two sentences in the request's units; numbers with three significant digits.")
            .field("figures", &F::figures,
                   numbers_by_name("Every number of the text under its name, in full precision."),
                   "The numbers in the sentence.");
        return d;
    }();
    return description;
}

namespace {

Json whole_number(SchemaBook&) { return {{"type", "integer"}}; }

// The codec of a member of the entry's evaluation; left out if there is none.
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

// One of the entry's reports; left out if there is none of this kind.
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
                   "Excess of this entry's load IAE over it; below 0 is possible with another filter or a larger Mt.",
                   {.unit = "%"})
            .why_null("Unknown for this entry.");
        return d;
    }();
    return description;
}

const Description<Standing>& standing_contract() {
    static const auto description = [] {
        using S = Standing;
        Description<S> d("Standing", "Data of an entry for the ranking.");
        using enum StandingGroup;
        d.field("group", &S::group,
                only_answered(choice<StandingGroup>({{"holds", holds},
                                                     {"above_limit", above_limit},
                                                     {"not_settled", not_settled},
                                                     {"unstable", unstable}})),
                "Groups rank in this order. above_limit: it settles, but its Ms exceeds the limit of the entry or of "
                "the comparison; not_settled: it is stable, but a response does not settle at its target.")
            .field("settles", &S::settles, boolean(),
                   "True if it is stable and both responses settle at their targets; for a nonlinear plant the plant's "
                   "own responses.")
            .field("Ms", &S::Ms, figure(),
                   "Ms of the implemented loop: on the worst plant, with the user's own controller.")
            .field("within", &S::within, boolean(), "True if the entry's own limit on Ms holds, or there is none.")
            .field("excess_percent", &S::excess_percent, figure(),
                   "Excess of the load IAE over the least that a PID reaches on the linear plant at the same Ms, or at "
                   "the nearest Ms with an optimum; for a nonlinear plant with its own load IAE.",
                   {.unit = "%"})
            .field(
                "order", {}, [](const S& standing, Writer& out) { out.integer(standing.order); }, whole_number,
                "Rank, from 1, without a limit on Ms for the comparison: with this order and least_limit a client can "
                "rank under another limit.")
            .field("least_limit", &S::min_limit, figure(),
                   "The smallest limit on Ms for the comparison with which the group is holds.")
            .field(
                "why", {}, [](const S& standing, Writer& out) { out.text(standing.why); }, words().schema,
                "Reason for a group other than holds; left out for holds.", {},
                [](const S& standing) { return standing.holds(); })
            .why_null("The loop is unstable, on this plant or on another one for which it is designed.");
        return d;
    }();
    return description;
}

const Description<OperatingPoint>& operating_point_contract() {
    static const auto description = [] {
        Description<OperatingPoint> d("OperatingPoint",
                                      "The exact steady state nearest to the given values; absolute values.");
        d.field(
             "states", {},
             [](const OperatingPoint& point, Writer& out) {
                 out.begin_object();
                 for (const NamedValue& state : point.states) out.key(state.name).number(state.value);
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

// The fields operating_point and linear_model of an answer; left out if `of` returns null.
template <class Answer>
void add_operating_point(Description<Answer>& d, Callable<const OperatingPoint*(const Answer&)> of) {
    const auto none = [of](const Answer& answer) { return of(answer) == nullptr; };
    d.field(
         "operating_point", {},
         [of](const Answer& answer, Writer& out) { operating_point_contract().write(*of(answer), out); },
         [](SchemaBook& book) { return operating_point_contract().schema(book); },
         "For a nonlinear plant: the steady state to which all deviations refer.", {}, none)
        .field(
            "linear_model", {},
            [of](const Answer& answer, Writer& out) { plant_contract().write(of(answer)->linear_model, out); },
            [](SchemaBook& book) { return plant_contract().schema(book); },
            "For a nonlinear plant: the linearisation there, which methods and robustness use.", {}, none);
}

constexpr const char* kEntries =
    "One entry per method and then one per given controller, in the order of the request; the baseline last.";
constexpr const char* kReplay =
    "The record of a loop in automatic as it was; the `replay` of each entry has the same time with its controller.";
constexpr const char* kEntryReplay =
    "The recorded time with this controller; left out if `replay` of the answer is refused.";

constexpr const char* kWhichToTake =
    "Findings on all entries: the proposed one, and the comparison with today's settings; the most important first.";

Json problem_reference(SchemaBook&) { return {{"$ref", "#/components/schemas/Problem"}}; }

const OperatingPoint* pointer(const std::optional<OperatingPoint>& point) { return point ? &*point : nullptr; }

bool no_method(const TuningEntry& entry) { return entry.method.empty(); }

void add_method_fields(Description<TuningEntry>& d) {
    const auto word = [](SchemaBook&) { return Json{{"type", "string"}}; };
    d.field(
         "method", {}, [](const TuningEntry& entry, Writer& out) { out.text(entry.method); }, word,
         "Id of the method; given for `controllers` of the request, baseline for today's settings.", {}, no_method)
        .field(
            "title", {}, [](const TuningEntry& entry, Writer& out) { out.text(entry.title); }, word, "Its name.", {},
            no_method)
        .field(
            "source", {}, [](const TuningEntry& entry, Writer& out) { out.text(entry.source); }, word,
            "Its publication.", {}, [](const TuningEntry& entry) { return entry.source.empty(); })
        .field(
            "options", {},
            [](const TuningEntry& entry, Writer& out) { write_options(entry.method, entry.options, out); },
            [](SchemaBook&) {
                return Json{{"type", "object"}, {"additionalProperties", true}};
            },
            "Options, with defaults for those that were not given.", {},
            [](const TuningEntry& entry) { return entry.is_given(); });
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
         "null: none was found. Not for today's settings.",
         {.unit = "time"}, [](const TuningEntry& entry) { return !entry.longest_sample_time; })
        .field(
            "as_entered", {},
            [](const TuningEntry& entry, Writer& out) {
                const device::Fitted& f = entry.on_device->fitted;
                settings_answer_contract().write({f.product, f.settings, f.typed, f.controller, f.notes, f.context},
                                                 out);
            },
            [](SchemaBook& book) { return settings_answer_contract().schema(book); },
            "With implement.product: the settings to type into the product.", {},
            [](const TuningEntry& entry) { return !entry.on_device || entry.on_device->fitted.typed.empty(); })
        .field(
            "implemented", {},
            [](const TuningEntry& entry, Writer& out) { implemented_contract().write(*entry.on_device, out); },
            [](SchemaBook& book) { return implemented_contract().schema(book); },
            "With implement: the loop with the user's own controller.", {}, none);
}

Codec<std::vector<verdict::Finding>> findings() { return list_of(answer(finding_contract())); }

const Description<TuningEntry>& entry_contract() {
    static const auto description = [] {
        Description<TuningEntry> d("Entry", "One controller with its evaluation, or the reason why there is none.");
        add_method_fields(d);
        d.field(
            "over_region", {}, [](const TuningEntry&, Writer& out) { out.boolean(true); },
            [](SchemaBook&) {
                return Json{{"type", "boolean"}};
            },
            "Limits hold over the record's 95 % confidence region; left out if they hold on the model alone.", {},
            [](const TuningEntry& entry) { return !entry.over_region; });
        d.field(
            "region_cost", {}, [](const TuningEntry& entry, Writer& out) { out.number(*entry.region_cost); },
            [](SchemaBook&) {
                return Json{{"type", "number"}};
            },
            "With over_region: the load IAE divided by that of the design on the model alone.", {},
            [](const TuningEntry& entry) { return !entry.region_cost; });
        d.field("verdict", &TuningEntry::verdict, findings(),
                "The meaning of the figures, the most important first. The first finding describes the loop; its level "
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
            "The controller. For a request with ultimate it has no figures of a loop.", {},
            [](const TuningEntry& entry) { return !entry.unjudged && !entry.evaluation; });
        evaluation_field(d, "equivalents", &Evaluation::equivalents, object(equivalents_contract()),
                         "The same loop in other forms.");
        evaluation_field(d, "robustness", &Evaluation::robustness, object(robustness_contract()), "Peaks and margins.");
        evaluation_field(d, "nonlinear", &Evaluation::nonlinear, maybe(answer(nonlinear_contract())),
                         "For the form npid: whether errors of every size die out.");
        evaluation_field(d, "performance", &Evaluation::performance, object(performance_contract()),
                         "Figures of the responses.");
        evaluation_field(d, "responses", &Evaluation::responses, maybe(answer(responses_contract())),
                         "Traces over time; left out with points 0 and for unstable loops.");
        evaluation_field(
            d, "linear", &Evaluation::linear, maybe(answer(linear_contract())),
            "For a nonlinear plant, whose own performance and responses are above: those of its linearisation.");
        evaluation_field(d, "frequency", &Evaluation::frequency, maybe(answer(frequency_contract())),
                         "Traces over frequency; left out with points 0.");
        evaluation_field(d, "verification", &Evaluation::verification, object(verification_contract()),
                         "Checks of the figures.");
        evaluation_field(
            d, "region", &Evaluation::region, maybe(answer(region_contract())),
            "Figures over all plants for which the controller is designed; left out if there is only one.");
        add_device_entry(d);
        add_reports(d, false);
        d.field("optimum_at_Ms", &TuningEntry::optimum_at_Ms, maybe(answer(optimum_contract())),
                "Comparison with the least load IAE that a PID reaches at the same Ms, if requested.")
            .field("replay", &TuningEntry::replay, maybe(answer(replayed_entry_contract())), kEntryReplay)
            .field("own_step", &TuningEntry::own_step, maybe(answer(own_step_entry_contract())),
                   "With evaluate.own_step: that step with this controller.")
            .field("standing", &TuningEntry::standing, maybe(answer(standing_contract())), "Data for the ranking.");
        add_reports(d, true);
        evaluation_field(d, "compute_ms", &Evaluation::compute_ms, number(), "Computing time of this entry, ms.");
        d.field(
            "error", {}, [](const TuningEntry& entry, Writer& out) { out.raw(to_json(to_problem(*entry.error))); },
            problem_reference, "Reason why the method has no controller.", {},
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
             out.key("Ms").number(*of(answer).rank_Ms);
             out.end_object();
         },
         [](SchemaBook&) {
             return Json{{"type", "object"}, {"properties", {{"Ms", {{"type", "number"}}}}}, {"required", {"Ms"}}};
         },
         "The limits of `standing` and the ranking: those of the request, or their defaults. Left out if the entries "
         "are "
         "not ranked.",
         {}, [of](const Answer& answer) { return !of(answer).rank_Ms; })
        .field(
            "proposed", {}, [of](const Answer& answer, Writer& out) { out.integer(*of(answer).proposed); },
            whole_number,
            "Index of the entry to show first: the one that the verdict proposes, or the nearest to today's settings; "
            "else the first with a controller.",
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
            words().schema, "Criterion of the ranking.");
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
                [](SchemaBook& book) { return model_contract().schema(book); }, "The model identified from the record.",
                none, [](const ResultAnswer& a) { return !a.result.model; })
            .field(
                "replay", {},
                [](const ResultAnswer& a, Writer& out) { replayed_record_contract().write(*a.result.replay, out); },
                [](SchemaBook& book) { return replayed_record_contract().schema(book); }, kReplay, none,
                [](const ResultAnswer& a) { return !a.result.replay; });
        add_operating_point<ResultAnswer>(d, [](const ResultAnswer& a) { return pointer(a.result.operating_point); });
        d.field(
             "controllers", {},
             [](const ResultAnswer& a, Writer& out) {
                 list_of(answer(entry_contract())).write(a.result.controllers, out);
             },
             list_of(answer(entry_contract())).schema, kEntries)
            .field(
                "verdict", {}, [](const ResultAnswer& a, Writer& out) { findings().write(a.result.verdict, out); },
                findings().schema, kWhichToTake);
        add_ranking<ResultAnswer>(d, [](const ResultAnswer& a) -> const TuningResult& { return a.result; });
        d.field(
             "partial", {}, [](const ResultAnswer& a, Writer& out) { out.boolean(a.result.partial); }, boolean().schema,
             "True: cancelled after a feasible design was found; this is the best so far.")
            .field(
                "version", {}, [](const ResultAnswer&, Writer& out) { out.text(TUNEWRIGHT_VERSION); }, words().schema,
                "Version of the service.")
            .field("request_hash", &ResultAnswer::request_hash, words(),
                   "SHA-256 of the request in its canonical form.")
            .field(
                "seed", {}, [](const ResultAnswer&, Writer& out) { out.integer(0); }, whole_number,
                "Seed of random numbers; no method of this version uses any.");
        return d;
    }();
    return description;
}

const Description<TuningResult>& design_answer_contract() {
    static const auto description = [] {
        using R = TuningResult;
        Description<R> d("DesignAnswer", "The result of a job, without name and date.");
        d.field("model", &R::model, maybe(answer(model_contract())),
                "Model of a record; left out if the request contains it.")
            .field("replay", &R::replay, maybe(answer(replayed_record_contract())), kReplay);
        add_operating_point<R>(d, [](const R& a) { return pointer(a.operating_point); });
        d.field("controllers", &R::controllers, list_of(answer(entry_contract())), kEntries)
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
