#include "api/contract/request.h"

#include <set>

#include "api/contract/controller.h"
#include "api/contract/methods.h"
#include "api/contract/own_step.h"
#include "api/contract/plant/typed.h"
#include "api/contract/product/product.h"
#include "api/contract/range/range_request.h"
#include "api/contract/relay.h"
#include "api/contract/result/identified_model.h"
#include "engine/evaluation/evaluate.h"
#include "engine/request/identified_region.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/registry.h"

namespace tunewright::api {
namespace {

// Checks that every plant forms a loop with the controller at the reader's place.
void check_loops(const AnalysedPlant& subject, const std::optional<SentController>& controller, Reader& reader) {
    if (!controller || !controller->given) return;
    if (const auto fault = loop_fault(subject, controller->given->law))
        reader.fault_below(fault->where, 1, fault->message);
}

void check_loops(const AnalysedPlant& subject, const std::vector<SentController>& controllers, Reader& reader) {
    const Reader::At list(reader, "controllers");
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        const Reader::At at(reader, i);
        check_loops(subject, controllers[i], reader);
    }
}

template <class Request>
void resolve_record(const Json&, Request& request, Reader& reader) {
    if (!request.record) return;
    const Reader::At at(reader, "record");
    request.read = resolve(std::move(*request.record), request.units.value_or(Units{}), reader);
}

// A request with Ku and Pu alone evaluates no loop, so members about a loop are not allowed.
void check_ultimate(const Json& value, JobRequest& request, Reader& reader) {
    if (!value.contains("ultimate")) return;
    for (const char* judged : {"controllers", "baseline", "implement", "evaluate", "identify", "uncertainty"})
        if (value.contains(judged))
            reader.fault_at(judged,
                            std::string(judged) + " needs a plant or a record: leave it out together with ultimate.");
    if (!value.contains("tune")) request.tune = {MethodRequest{"all", {}}};
}

constexpr std::size_t kMaxControllers = 50;

const std::vector<std::string> kJobSources = {"plant", "record", "ultimate"},
                               kDesignSources = {"plant", "record", "model"}, kEvaluateSources = {"plant", "model"};

verdict::GivenSteps given_steps(const Json& request) {
    const auto evaluate = request.find("evaluate");
    if (evaluate == request.end() || !evaluate->is_object()) return {};
    return {evaluate->contains("setpoint_step"), evaluate->contains("load_step")};
}

/// Checks that the request has exactly one of `sources`, members that exclude each other; `others`: how to ask for
/// those that may accompany a plant.
void check_source(const Json& value, const std::vector<std::string>& sources, const std::string& others,
                  Reader& reader) {
    std::vector<std::string> given;
    for (const std::string& source : sources)
        if (value.contains(source)) given.push_back(source);
    if (given.size() > 1)
        reader.fault_at(
            given[1], given[1] + " and " + given[0] + " are both given; a request takes only one of them. Remove one.");
    if (given.empty())
        reader.fault(listed(sources) +
                     " is missing; give a plant such as {\"type\": \"fopdt\", \"K\": 2, \"T\": 10, "
                     "\"L\": 3}, " +
                     others + ".");
}

constexpr const char* kFromRecord = "from-record";

void read_baseline(const Json& value, JobRequest& request, Reader& reader) {
    request.baseline_from_record = value == kFromRecord;
    if (request.baseline_from_record) return;
    maybe(sent_controller()).read(value, request.baseline, reader);
}

void write_baseline(const JobRequest& request, Writer& out) {
    if (request.baseline_from_record) return out.text(kFromRecord);
    maybe(sent_controller()).write(request.baseline, out);
}

Json baseline_schema(SchemaBook& book) {
    Json schema = sent_controller().schema(book);
    schema["oneOf"].push_back({{"const", kFromRecord}});
    return schema;
}

// Settings typed into a product need a unit of time; one fault for all of them.
void resolve(std::vector<SentController>& controllers, const std::optional<GivenDevice>& implement,
             const std::string& time, Reader& reader) {
    const Reader::At list(reader, "controllers");
    const bool typed =
        std::ranges::any_of(controllers, [](const SentController& one) { return one.typed.has_value(); });
    if (typed && !seconds_per_time(time, reader)) return;
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        const Reader::At at(reader, i);
        resolve(controllers[i], implement, time, reader);
    }
}

template <class Request>
void resolve_device(Request& request, Reader& reader) {
    if (!request.implement) return;
    const std::string time = request.units.value_or(Units{}).time_or_default();
    if (request.implement->product && !seconds_per_time(time, reader)) return;
    const Reader::At at(reader, "implement");
    request.device = device_of(*request.implement, time, reader);
    if (request.device) check_needs(*request.device, reader);
}

void check_implement(const Json&, JobRequest& request, Reader& reader) {
    resolve_device(request, reader);
    const std::string time = request.units.value_or(Units{}).time_or_default();
    resolve(request.controllers, request.implement, time, reader);
    if (!request.baseline) return;
    if (request.baseline->typed && !seconds_per_time(time, reader)) return;
    const Reader::At at(reader, "baseline");
    resolve(*request.baseline, request.implement, time, reader);
}

void check_job(const Json& value, JobRequest& request, Reader& reader) {
    request.given_steps = given_steps(value);
    if (request.tune.empty() && request.controllers.empty())
        reader.fault_at("tune", "tune has 0 elements; it must have 1 to " + std::to_string(kMaxMethods) +
                                    ". It may be empty if controllers are given.");
    if (request.uncertainty == "identified" && !request.record && !request.model) {
        reader.fault_at("uncertainty",
                        "uncertainty is \"identified\", which needs a record. For a plant give uncertainty in the "
                        "plant, such as {\"K\": [0.8, 1.2]}.");
    }
    if (request.uncertainty == "identified" && request.model && request.model->covariance.names.empty()) {
        const Reader::At at(reader, "model");
        reader.fault_at("covariance",
                        "covariance is missing, and uncertainty \"identified\" needs it. Send the model as in the "
                        "answer, or use uncertainty \"auto\" or \"none\".");
    }
    if (request.baseline_from_record && !request.record)
        reader.fault_at("baseline", "baseline is \"from-record\", which needs a record. Give the settings instead.");
    if (!request.plant) return;
    request.subject = subject_of(*request.plant, reader);
    if (!request.subject) return;
    check_loops(*request.subject, request.controllers, reader);
    const Reader::At at(reader, "baseline");
    check_loops(*request.subject, request.baseline, reader);
}

/// The analysed plant of a model that was read without a fault.
std::optional<AnalysedPlant> made_of(const IdentifiedModel& model, Reader& reader) {
    auto made = subject_of(model);
    if (made) return std::move(*made);
    reader.fault_at("model", made.error().message);
    return std::nullopt;
}

void check_controllers(const Json& value, EvaluateRequest& request, Reader& reader) {
    request.given_steps = given_steps(value);
    request.subject = request.model ? made_of(*request.model, reader) : subject_of(*request.plant, reader);
    resolve(request.controllers, request.implement, request.units.value_or(Units{}).time_or_default(), reader);
    if (request.subject) check_loops(*request.subject, request.controllers, reader);
}

// The common members of a job and a design, other than the plant and the methods.
template <class Request>
void add_judged(Description<Request>& d) {
    d.field(
         "baseline", [](const Json& value, Request& request, Reader& reader) { read_baseline(value, request, reader); },
         [](const Request& request, Writer& out) { write_baseline(request, out); }, baseline_schema,
         "Today's settings, which become the last entry: a controller, a product with its settings as typed, or "
         "from-record: as POST /v1/records/controller finds them.",
         {}, [](const Request& request) { return !request.baseline && !request.baseline_from_record; })
        .field("implement", &Request::implement, maybe(object(implement_contract())),
               "The user's own controller, for which entries are converted and evaluated.")
        .field("evaluate", &Request::evaluate, object(evaluate_options_contract()),
               "Options of the simulation and the answer.");
}

constexpr const char* kModelSentence =
    "The `model` of an answer for a record, sent back instead of the record: the record is not identified again.";

// Checks that apply to the requests of a job and of a design.
template <class Request>
void add_question(Description<Request>& d) {
    d.field("identify", &Request::identify, object(identify_contract()), "Identification of the record.")
        .field("tune", &Request::tune, tune_list(),
               "The methods, each with one entry of the answer; \"all\": every method. May be empty if there are "
               "controllers.")
        .field("controllers", &Request::controllers, list_of(sent_controller(), 0, kMaxControllers),
               "Controllers of your choice, judged like designs: each as a law or as the settings typed into a "
               "product.");
    add_judged(d);
    d.field("uncertainty", &Request::uncertainty,
            choice<std::string>({{"auto", "auto"}, {"none", "none"}, {"identified", "identified"}}),
            "identified: robust holds its limits over the record's 95 % confidence region. auto: if the design on the "
            "model alone exceeds a limit there, both designs are returned, first the one over the region.");
}

template <class Request>
void add_checks(Description<Request>& d) {
    d.check([](const Json& value, Request& request, Reader& reader) { check_implement(value, request, reader); })
        .check([](const Json& value, Request& request, Reader& reader) { check_job(value, request, reader); })
        .check(resolve_record<Request>);
}

}  // namespace

std::optional<AnalysedPlant> subject_of(const PlantModel& plant, Reader& reader) {
    auto made = AnalysedPlant::make(plant);
    if (auto* subject = std::get_if<AnalysedPlant>(&made)) return std::move(*subject);
    for (const Error& fault : std::get<std::vector<Error>>(made)) reader.fault_below(fault.where, 0, fault.message);
    return std::nullopt;
}

const Description<JobRequest>& job_contract() {
    static const auto description = [] {
        Description<JobRequest> d("TuningRequest",
                                  "A plant or a recorded test, and the methods and evaluation of its controllers.");
        add_labels(d);
        d.field("plant", &JobRequest::plant, maybe(plant_model_or_text()),
                "The plant; exactly one of plant, record and ultimate.")
            .field("record", &JobRequest::record, maybe(object(record_contract())),
                   "The recorded test; exactly one of plant, record and ultimate.")
            .field("ultimate", &JobRequest::ultimate, maybe(object(ultimate_contract())),
                   "Instead of both: only ultimate gain and period. The rules that need no more give settings, without "
                   "figures of a loop.");
        add_question(d);
        add_terms(d);
        d.check_presence([](const Json& value, JobRequest& request, Reader& reader) {
             check_source(value, kJobSources, "a recorded test, or only an ultimate gain and period", reader);
             check_ultimate(value, request, reader);
         })
            .refuse("structure", "structure must be cascade, level, feedforward, interaction or predictor.")
            .example({{"name", "TIC-101"},
                      {"plant", {{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}}},
                      {"tune",
                       Json::array({Json{
                           {"method", default_method()}, {"Ms", limits::kDefaultMs}, {"Mt", limits::kDefaultMt}}})}});
        add_checks(d);
        return d;
    }();
    return description;
}

const Description<DesignRequest>& design_request_contract() {
    static const auto description = [] {
        using D = DesignRequest;
        Description<D> d("DesignRequest",
                         "The request of a job, without the terms on which a job is run; instead of a record also the "
                         "model identified from it.");
        add_labels(d);
        d.field("plant", &D::plant, maybe(plant_model_or_text()), "The plant; exactly one of plant, record and model.")
            .field("record", &D::record, maybe(object(record_contract())), "The recorded test.")
            .field("model", &D::model, maybe(object(model_contract())), kModelSentence);
        add_question(d);
        d.field("start", &D::start, maybe(one_of(controller_contract())),
                "A similar design, such as the last answer: a hint. The search is complete, so that the answer does "
                "not depend on it.")
            .check_presence([](const Json& value, D&, Reader& reader) {
                check_source(value, kDesignSources, "a recorded test, or the model of one", reader);
            })
            .example({{"plant", {{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}}},
                      {"tune", Json::array({Json{{"method", default_method()}, {"Ms", 1.6}, {"Mt", 1.6}}})}});
        add_checks(d);
        return d;
    }();
    return description;
}

const Description<EvaluateRequest>& evaluate_request_contract() {
    static const auto description = [] {
        Description<EvaluateRequest> d("EvaluateRequest", "A plant, or the model of a record, and controllers for it.");
        add_labels(d);
        d.field("plant", &EvaluateRequest::plant, maybe(plant_model_or_text()),
                "The plant; exactly one of plant and model.")
            .field("model", &EvaluateRequest::model, maybe(object(model_contract())), kModelSentence)
            .field("controllers", &EvaluateRequest::controllers, list_of(sent_controller(), 1, kMaxControllers),
                   "The controllers, each as a law or as the settings typed into a product.", {.required = true})
            .field("evaluate", &EvaluateRequest::evaluate, object(evaluate_options_contract()),
                   "Options of the simulation and the answer.")
            .field("implement", &EvaluateRequest::implement, maybe(object(implement_contract())),
                   "The user's own controller, on which they are evaluated too.")
            .check_presence([](const Json& value, EvaluateRequest&, Reader& reader) {
                check_source(value, kEvaluateSources, "or the model of a record", reader);
            })
            .check(check_controllers)
            .check([](const Json&, EvaluateRequest& request, Reader& reader) { resolve_device(request, reader); })
            .example({{"plant", {{"type", "fopdt"}, {"K", 2}, {"T", 10}, {"L", 3}}},
                      {"controllers", Json::array({Json{{"form", "ideal"}, {"Kp", 0.9}, {"Ti", 10}}})}});
        return d;
    }();
    return description;
}

const Description<IdentifyRequest>& identify_request_contract() {
    static const auto description = [] {
        Description<IdentifyRequest> d("IdentifyRequest", "A recorded test.");
        add_labels(d);
        d.field("record", &IdentifyRequest::record, maybe(object(record_contract())), "The recorded test.",
                {.required = true})
            .field("identify", &IdentifyRequest::identify, object(identify_contract()), "Identification of the record.")
            .check(resolve_record<IdentifyRequest>);
        return d;
    }();
    return description;
}

const std::vector<std::string>& request_sources() {
    static const std::vector<std::string> sources = [] {
        std::set<std::string> all;
        for (const auto* some : {&kJobSources, &kDesignSources, &kEvaluateSources})
            all.insert(some->begin(), some->end());
        return std::vector<std::string>(all.begin(), all.end());
    }();
    return sources;
}

bool is_request_member(std::string_view name) {
    return job_contract().has(name) || design_request_contract().has(name) || evaluate_request_contract().has(name) ||
           identify_request_contract().has(name) || range_request_contract().has(name);
}

std::vector<GivenController> given(const std::vector<SentController>& controllers) {
    std::vector<GivenController> all;
    for (const SentController& sent : controllers) all.push_back(*sent.given);
    return all;
}

TuningRequest to_engine(JobRequest request) {
    TuningRequest out;
    out.subject = std::move(request.subject);
    if (request.record) out.record = std::move(request.read.record);
    out.ultimate = request.ultimate;
    out.model = std::move(request.model);
    out.identify = request.identify;
    out.tune = std::move(request.tune);
    out.controllers = given(request.controllers);
    if (request.baseline) out.baseline = request.baseline->given;
    out.device = request.device;
    out.evaluate = request.evaluate;
    out.own_step = request.evaluate.own_step;
    out.given_steps = request.given_steps;
    out.labels = labels_of(request.units);
    out.identified_region = request.uncertainty == "identified" ? IdentifiedRegion::held
                            : request.uncertainty == "none"     ? IdentifiedRegion::unused
                                                                : IdentifiedRegion::where_needed;
    return out;
}

namespace {

constexpr int kMaxPoints = 20'000;

}  // namespace

Codec<int> trace_points() {
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

namespace {

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
                                    "White measurement noise; it is reported separately and never affects IAE or TV.");
        d.field("std", &NoiseOptions::std, number({.minimum = 0}), "Standard deviation, >= 0.", {.unit = "y"})
            .field("sample_time", &NoiseOptions::sample_time, number({.minimum = 0}),
                   "Time between samples; 0: 1/100 of the shorter of the loop's time constants.", {.unit = "time"});
        return d;
    }();
    return description;
}

/// A member of the engine's options.
template <class T>
T EvaluateQuestion::*own(T EvaluateOptions::*member) {
    return member;
}

}  // namespace

const Description<EvaluateQuestion>& evaluate_options_contract() {
    static const auto description = [] {
        using Q = EvaluateQuestion;
        Description<Q> d("Evaluate", "Options of the simulation and extent of the answer.");
        d.field("setpoint_step", own(&EvaluateOptions::setpoint_step), number({.not_zero = true}),
                "Size of the set-point step.", {.unit = "y"})
            .field("load_step", own(&EvaluateOptions::load_step), number({.not_zero = true}),
                   "Size of the load step at the plant's input.", {.unit = "u"})
            .field(
                "horizon", own(&EvaluateOptions::horizon), horizon(),
                "Length of the responses; a number also ends the indices, which with auto are integrals to infinity.",
                {.unit = "time"})
            .field("points", own(&EvaluateOptions::points), trace_points(),
                   "Points of each trace: 0 (no traces) or 2 to 20000.")
            .field("actuator", own(&EvaluateOptions::actuator), maybe(object(actuator_contract())), "Limits of u.")
            .field("noise", own(&EvaluateOptions::noise), maybe(object(noise_contract())), "Measurement noise.")
            .field("own_step", &Q::own_step, maybe(object(own_step_contract())),
                   "A step of the user's own loop, simulated with every controller.")
            .field("tradeoff", own(&EvaluateOptions::tradeoff), boolean(),
                   "Also return each controller's trade-off between set points and loads.")
            .field(
                "rank_limits",
                [](const Json& value, Q& options, Reader& reader) {
                    if (!value.is_object())
                        return reader.fault(wrong_kind(value, "an object such as {\"Ms\": 2}", reader));
                    for (const auto& [name, member] : value.items()) {
                        const Reader::At at(reader, name);
                        if (name != "Ms") {
                            reader.fault(name + " is not a field here; the only one is Ms.");
                        } else if (const auto read = read_number(member, {.exclusive_minimum = 1}, reader)) {
                            options.rank_Ms = *read;
                        }
                    }
                },
                [](const Q& options, Writer& out) {
                    out.begin_object();
                    out.key("Ms").number(options.rank_Ms.value_or(limits::kDefaultMaxRankedMs));
                    out.end_object();
                },
                [](SchemaBook&) {
                    return Json{
                        {"type", "object"},
                        {"properties",
                         {{"Ms",
                           {{"type", "number"}, {"exclusiveMinimum", 1}, {"default", limits::kDefaultMaxRankedMs}}}}},
                        {"additionalProperties", false}};
                },
                "Entries that exceed these limits rank last.")
            .field("optimum_at_Ms", own(&EvaluateOptions::optimum_at_Ms), maybe(boolean()),
                   "True: compare each entry with the robust PID of the least load IAE at the same Ms. Default: true "
                   "if a job compares several methods, else false.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
