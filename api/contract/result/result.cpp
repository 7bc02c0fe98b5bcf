#include "api/contract/result/result.h"

#include "api/contract/controller.h"
#include "api/contract/data_quality.h"
#include "api/contract/methods.h"
#include "api/contract/plant/plant.h"
#include "api/contract/reports/reports.h"
#include "api/contract/result/evaluation.h"
#include "api/contract/result/limit_cycle.h"
#include "api/contract/result/operating_point.h"
#include "api/contract/result/optimum_at_ms.h"

namespace tunewright::api {
namespace {

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
                return Json{{"type", "object"}};
            },
            "Options given, over the defaults.", {},
            [](const TuningEntry& entry) { return entry.method.empty() || entry.method == "baseline"; });
}

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
        evaluation_field(d, "warnings", &Evaluation::warnings, list_of(answer(warning_contract())), "Remarks.");
        d.field("reduced_model", &TuningEntry::reduced_model, maybe(only_answered(one_of(plant_contract()))),
                "The simpler model that the rule used.");
        evaluation_field(d, "controller", &Evaluation::controller, one_of(controller_contract()), "The controller.");
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
        add_reports(d, false);
        d.field("optimum_at_Ms", &TuningEntry::optimum_at_Ms, maybe(answer(optimum_contract())),
                "Beside the least load IAE that a PID reaches at the same Ms, where asked for.");
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

Codec<std::map<std::string, double>> standard_errors() { return numbers_by_name("Symbol of the parameter."); }

const Description<Candidate>& candidate_contract() {
    static const auto description = [] {
        Description<Candidate> d("Candidate", "A structure that was tried.");
        d.field("plant", &Candidate::plant, only_answered(one_of(plant_contract())), "The model.")
            .field("fit_percent", &Candidate::fit_percent, only_answered(number()),
                   "100 (1 - |y - yhat|/|y - mean(y)|), free run.")
            .field("criterion", &Candidate::criterion, only_answered(number()),
                   "Information criterion; smaller is better.")
            .field("standard_errors", &Candidate::standard_errors, standard_errors(), "By parameter.")
            .field("y_model", &Candidate::y_model,
                   unless<std::vector<double>>(trace(), [](const auto& y_model) { return y_model.empty(); }),
                   "Simulated, at the times of the model's fit; with identify.traces.", {.unit = "y"});
        return d;
    }();
    return description;
}

const Description<ParameterCovariance>& covariance_contract() {
    static const auto description = [] {
        Description<ParameterCovariance> d("Covariance", "How the errors of the model's parameters belong together.");
        d.field("names", &ParameterCovariance::names, list_of(words()), "Order of rows and columns.")
            .field(
                "matrix", {},
                [](const ParameterCovariance& covariance, Writer& out) {
                    out.begin_array();
                    for (const auto& row : covariance.matrix) {
                        out.begin_array();
                        for (const double value : row) out.number(value);
                        out.end_array();
                    }
                    out.end_array();
                },
                [](SchemaBook&) {
                    return Json{{"type", "array"}, {"items", {{"type", "array"}, {"items", {{"type", "number"}}}}}};
                },
                "Symmetric.");
        return d;
    }();
    return description;
}

const Description<ExcitedBand>& band_contract() {
    static const auto description = [] {
        Description<ExcitedBand> d("ExcitedBand",
                                   "Where the answer to u stands out of the noise: the record's own estimate of "
                                   "P(j omega) has a relative standard error below 100 %.");
        d.field("omega_low", &ExcitedBand::omega_low, only_answered(number()), "2 pi over the record's length.",
                {.unit = "rad/time"})
            .field("omega_high", &ExcitedBand::omega_high, only_answered(number()), "Upper end.", {.unit = "rad/time"});
        return d;
    }();
    return description;
}

const Description<FitTrace>& fit_contract() {
    static const auto description = [] {
        Description<FitTrace> d(
            "Fit", "The model beside the record, six significant digits; times that need more to differ have more.");
        d.field("t", &FitTrace::t, times_trace(), "Time.", {.unit = "time"})
            .field("u", &FitTrace::u, trace(), "The input as recorded, held between samples.", {.unit = "u"})
            .field("y", &FitTrace::y, trace(), "Measured.", {.unit = "y"})
            .field("y_model", &FitTrace::y_model, trace(), "Simulated.", {.unit = "y"});
        return d;
    }();
    return description;
}

const Description<IdentifiedModel>& model_contract() {
    static const auto description = [] {
        using M = IdentifiedModel;
        Description<M> d("Model", "The plant that was found in the record.");
        d.field("plant", &M::plant, only_answered(one_of(plant_contract())), "The model.")
            .field("fit_percent", &M::fit_percent, only_answered(number()),
                   "100 (1 - |y - yhat|/|y - mean(y)|), free run, offset estimated.")
            .field("standard_errors", &M::standard_errors, standard_errors(), "By parameter.")
            .field("covariance", &M::covariance,
                   unless<ParameterCovariance>(answer(covariance_contract()),
                                               [](const auto& covariance) { return covariance.names.empty(); }),
                   "Of the parameters.")
            .field("limit_cycle", &M::limit_cycle, maybe(answer(limit_cycle_contract())), "Of a relay test.")
            .field("frequency_points", &M::frequency_points,
                   unless<std::vector<FrequencyPoint>>(list_of(answer(frequency_point_contract())),
                                                       [](const auto& points) { return points.empty(); }),
                   "Of the plant, from the record alone.")
            .field("ultimate_point", &M::ultimate_point, maybe(answer(ultimate_point_contract())),
                   "Of the model; left out where no gain makes it oscillate.")
            .field("excited_band", &M::excited_band, maybe(answer(band_contract())),
                   "The frequencies that the record tells something about.")
            .field("region", &M::region, maybe(answer(region_contract())),
                   "The best-ranked controller on the 95 % confidence region; each entry has its own.")
            .field("choice_reason", &M::choice_reason, words(), "Why this structure.")
            .field("candidates", &M::candidates, list_of(answer(candidate_contract())), "Structures that were tried.")
            .field("fit", &M::fit,
                   unless<FitTrace>(answer(fit_contract()), [](const auto& fit) { return fit.t.empty(); }),
                   "The model beside the record; with identify.traces.")
            .field("data_quality", &M::data_quality, answer(quality_contract()), "What was found in the record.")
            .field("warnings", &M::warnings, list_of(answer(warning_contract())), "Remarks.");
        return d;
    }();
    return description;
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
                "ranking", {},
                [](const ResultAnswer& a, Writer& out) {
                    out.begin_array();
                    for (const int index : a.result.ranking) out.integer(index);
                    out.end_array();
                },
                [](SchemaBook&) {
                    return Json{{"type", "array"}, {"items", {{"type", "integer"}}}};
                },
                "Indices into controllers, best first; entries without a controller are left out.")
            .field(
                "ranking_by", {}, [](const ResultAnswer& a, Writer& out) { out.text(a.result.ranking_by); },
                words().schema, "What they are ranked by.")
            .field(
                "partial", {}, [](const ResultAnswer& a, Writer& out) { out.boolean(a.result.partial); },
                boolean().schema, "True: cancelled after a feasible design was found; this is the best so far.")
            .field(
                "version", {}, [](const ResultAnswer&, Writer& out) { out.text(TUNEWRIGHT_VERSION); }, words().schema,
                "Of the service.")
            .field("request_hash", &ResultAnswer::request_hash, words(),
                   "SHA-256 of the request in its canonical spelling.")
            .field(
                "seed", {}, [](const ResultAnswer&, Writer& out) { out.integer(0); },
                [](SchemaBook&) {
                    return Json{{"type", "integer"}};
                },
                "Of random numbers; no method of this version uses any.");
        return d;
    }();
    return description;
}

const Description<EvaluationResult>& evaluate_answer_contract() {
    static const auto description = [] {
        Description<EvaluationResult> d("EvaluateAnswer", "The controllers in the order sent.");
        add_operating_point<EvaluationResult>(d, [](const EvaluationResult& a) { return pointer(a.operating_point); });
        d.field("controllers", &EvaluationResult::controllers, list_of(answer(entry_contract())),
                "One entry a controller.");
        return d;
    }();
    return description;
}

const Description<IdentifyAnswer>& identify_answer_contract() {
    static const auto description = [] {
        Description<IdentifyAnswer> d("IdentifyAnswer", "The model that was found in the record.");
        d.field("model", &IdentifyAnswer::model, answer(model_contract()), "The model.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
