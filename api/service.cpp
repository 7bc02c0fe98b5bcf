#include "api/service.h"

#include <algorithm>

#include "api/contract/controller.h"
#include "api/contract/controller_record.h"
#include "api/contract/plant/typed.h"
#include "api/contract/preview.h"
#include "api/contract/record.h"
#include "api/contract/relay.h"
#include "api/contract/reports/frontier.h"
#include "api/contract/request.h"
#include "api/contract/result/identified_model.h"
#include "api/contract/result/result.h"
#include "api/contract/structure/structure_name.h"
#include "api/describe/body.h"
#include "api/json/digest.h"
#include "api/json/json.h"
#include "api/outline.h"
#include "api/services/check_service.h"
#include "api/services/range_service.h"
#include "api/services/structure_service.h"
#include "engine/evaluation/best_so_far.h"
#include "engine/number_text.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/request/recorded_controller.h"
#include "engine/tuning/device/device_model.h"

namespace tunewright::api {
namespace {

JobOutcome failure(const Problem& problem) { return {JobOutcome::Status::failed, {}, to_json(problem)}; }

Answer identified(const ReadRecord& read, const IdentifyQuestion& question, const RunControl& control) {
    auto model = identify(read.record, question, control);
    if (!model) {
        Problem problem = to_problem(model.error());
        problem.record = samples_of(read.record, question.traces ? kPlotRows : kExcerptRows);
        return refusal(problem);
    }
    add_reading(read, *model);
    leave_out_traces(question, *model);
    Writer out;
    identify_answer_contract().write({std::move(*model)}, out);
    return {200, out.take()};
}

Problem timeout_too_long(double timeout_s, const JobLimits& limits) {
    Reader reader;
    reader.fault_at("timeout_s", "timeout_s is " + shown(timeout_s) + "; this service allows at most " +
                                     shown(limits.longest_timeout_s) + " s.");
    return *reader.problem();
}

/// True if a plant is a text, alone or among several.
bool is_typed(const Json& plant) {
    if (plant.is_string()) return true;
    const auto several = plant.is_object() ? plant.find("plants") : plant.end();
    return plant.is_object() && several != plant.end() && several->is_array() &&
           std::any_of(several->begin(), several->end(), [](const Json& one) { return one.is_string(); });
}

Json plant_json(const PlantModel& plant) {
    Writer out;
    plant_model_contract().write(plant, out);
    return Json::parse(out.view());
}

/// Replaces the text of a controller by the settings that were read in it. False if it is no such text.
bool canonicalise_controller(Json& value, const SentController& sent) {
    if (!value.is_string() || !sent.typed) return false;
    Writer out;
    sent_controller().write(sent, out);
    value = Json::parse(out.view());
    return true;
}

/// Typed plants and controllers are stored as their objects: readers of the job find a plant and settings, and all
/// spellings of them are the same request. False if there is none.
bool canonicalise_texts(Json& value, const JobRequest& request) {
    bool typed = request.plant && is_typed(value["plant"]);
    if (typed) value["plant"] = plant_json(*request.plant);
    if (request.baseline) typed |= canonicalise_controller(value["baseline"], *request.baseline);
    for (std::size_t k = 0; k < request.controllers.size(); ++k)
        typed |= canonicalise_controller(value["controllers"][k], request.controllers[k]);
    return typed;
}

bool canonicalise_texts(Json& value, const RangeRequest& request) {
    bool typed = false;
    if (!request.points) return typed;
    for (std::size_t k = 0; k < request.points->size(); ++k) {
        const auto& plant = (*request.points)[k].plant;
        if (!plant || !is_typed(value["points"][k]["plant"])) continue;
        value["points"][k]["plant"] = plant_json(*plant);
        typed = true;
    }
    return typed;
}

/// Records, and plants that a reader of the job finds as they were typed.
bool canonicalise_texts(Json&, const CheckRequest&) { return false; }
bool canonicalise_texts(Json&, const StructureRequest&) { return false; }

JobSubject subject_of(const Json& request) {
    if (!structure_of(request).empty()) return JobSubject::structure;
    if (is_check_request(request)) return JobSubject::check;
    return is_range_request(request) ? JobSubject::range : JobSubject::loop;
}

/// Calls `use` with the contract of the request.
template <class Use>
auto with_contract(const Json& request, const Use& use) {
    const std::string structure = structure_of(request);
    if (structure == "cascade") return use(cascade_request_contract());
    if (structure == "level") return use(level_request_contract());
    if (structure == "feedforward") return use(feedforward_request_contract());
    if (structure == "interaction") return use(interaction_request_contract());
    if (structure == "predictor") return use(predictor_request_contract());
    if (is_check_request(request)) return use(check_request_contract());
    return is_range_request(request) ? use(range_request_contract()) : use(job_contract());
}

JobOutcome outcome_of(JobRequest request, std::string_view hash, const RunControl& control);
JobOutcome outcome_of(RangeRequest request, std::string_view hash, const RunControl& control) {
    return range_outcome(std::move(request), hash, control);
}
JobOutcome outcome_of(CheckRequest request, std::string_view hash, const RunControl& control) {
    return check_outcome(std::move(request), hash, control);
}
template <std::derived_from<StructureRequest> Request>
JobOutcome outcome_of(const Request& request, std::string_view hash, const RunControl& control) {
    return structure_outcome(request, hash, control);
}

/// `text` is the stored request unless it has a typed plant or controller.
template <class Request, class Spelling>
std::variant<PreparedJob, Problem> prepared_as(const Description<Request>& contract, Json& value,
                                               const JobLimits& limits, const Spelling& text) {
    auto decoded = decode(value, contract);
    if (const auto* problem = std::get_if<Problem>(&decoded)) return *problem;
    auto& request = std::get<Request>(decoded);
    const bool given = value.contains("timeout_s");
    if (given && request.timeout_s > limits.longest_timeout_s) return timeout_too_long(request.timeout_s, limits);
    if (auto problem = refuse_far(request.not_before)) return *std::move(problem);
    const bool typed = canonicalise_texts(value, request);
    PreparedJob job{.name = request.name.value_or(""),
                    .timeout_s = given ? request.timeout_s : limits.default_timeout_s,
                    .request_json = typed ? value.dump() : text(),
                    .request_hash = {},
                    .notify = request.notify,
                    .low_priority = request.low_priority,
                    .not_before = request.not_before,
                    .unique = request.unique};
    leave_out_terms(value);
    job.request_hash = sha256_hex(canonical(value));
    job.subject = subject_of(value);
    job.run = [kept = std::make_shared<const Request>(std::move(request))](
                  std::string_view hash, const RunControl& control) { return outcome_of(*kept, hash, control); };
    return job;
}

template <class Spelling>
std::variant<PreparedJob, Problem> prepared(Json& value, const JobLimits& limits, const Spelling& text) {
    return with_contract(value, [&](const auto& contract) { return prepared_as(contract, value, limits, text); });
}

Json identify_json(const CsvRequest& question) {
    Json options{{"traces", question.traces}};
    if (!question.model.empty()) options["model"] = question.model;
    return options;
}

std::string method_label(const JobRequest& request) {
    if (request.tune.empty()) return kGivenMethod;
    return request.tune.size() == 1 ? request.tune.front().method : "several";
}

/// The result of a request, with the findings of reading its record.
Expected<TuningResult> tuned(JobRequest request, const RunControl& control) {
    ReadRecord read = request.read;
    read.record = {};
    const IdentifyQuestion question = request.identify;
    const bool recorded = request.record.has_value();
    std::vector<Warning> of_baseline;
    if (request.baseline_from_record) {
        auto today = recorded_controller(request.read.record, request.device ? &*request.device : nullptr);
        if (!today) return Error{today.error().kind, "baseline", today.error().message};
        request.baseline = SentController{{}, {}, GivenController(device::continuous(today->found.pid))};
        of_baseline = std::move(today->found.warnings);
    }
    auto result = tune(to_engine(std::move(request)), control);
    if (!result || !result->model) return result;
    for (TuningEntry& entry : result->controllers)
        if (entry.is_baseline() && entry.evaluation)
            entry.evaluation->warnings.insert(entry.evaluation->warnings.begin(), of_baseline.begin(),
                                              of_baseline.end());
    if (recorded) {
        add_reading(read, *result->model);
        leave_out_traces(question, *result->model);
    } else {
        // The client that sent the model already has it.
        result->model.reset();
    }
    return result;
}

/// The answer to a request whose hash is known.
JobOutcome outcome_of(JobRequest request, std::string_view hash, const RunControl& control) {
    const std::string method = method_label(request);
    const std::optional<Units> units = request.units;
    const Outline outline(request);
    auto result = tuned(std::move(request), control);
    if (!result) {
        JobOutcome outcome = failure(to_problem(result.error()));
        if (result.error().kind == ErrorKind::cancelled) outcome = {JobOutcome::Status::cancelled, {}, {}};
        outcome.method = method;
        return outcome;
    }
    std::string line = outline.of(*result);
    const auto status = result->partial ? JobOutcome::Status::cancelled : JobOutcome::Status::succeeded;
    Writer out;
    result_contract().write({std::move(*result), units, std::string(hash)}, out);
    return {status, out.take(), {}, method, std::move(line)};
}

}  // namespace

std::variant<PreparedJob, Problem> prepare_job(std::string_view body, const JobLimits& limits) {
    auto parsed = parse(body);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return *problem;
    return prepared(std::get<Json>(parsed), limits, [&] { return compact(body); });
}

std::variant<PreparedJob, Problem> prepare_range(std::string_view body, const JobLimits& limits) {
    auto parsed = parse(body);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return *problem;
    return prepared_as(range_request_contract(), std::get<Json>(parsed), limits, [&] { return compact(body); });
}

std::variant<PreparedJob, Problem> prepare_structure(std::string_view body, const std::string& structure) {
    auto parsed = parse(body);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return *problem;
    auto& value = std::get<Json>(parsed);
    if (value.is_object() && !value.contains("structure")) value["structure"] = structure;
    return with_contract(Json{{"structure", structure}}, [&](const auto& contract) {
        return prepared_as(contract, value, {}, [&] { return value.dump(); });
    });
}

void ask_for_no_traces(Json& request) {
    if (!request.is_object() || is_check_request(request)) return;
    if (is_range_request(request)) {
        if (!request.contains("runs")) request["runs"] = false;
        return;
    }
    if (!request.contains("evaluate")) request["evaluate"] = Json::object();
    Json& evaluate = request["evaluate"];
    if (evaluate.is_object() && !evaluate.contains("points")) evaluate["points"] = 0;
}

std::variant<PreparedJob, Problem> prepare_entry(std::string_view body, const JobLimits& limits) {
    auto parsed = parse(body);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return *problem;
    auto& value = std::get<Json>(parsed);
    if (auto problem = refuse_terms_of_entry(value)) return *std::move(problem);
    ask_for_no_traces(value);
    auto job = prepared(value, limits, [&] { return value.dump(); });
    // Entries wait for the store in groups, as text only.
    if (auto* ready = std::get_if<PreparedJob>(&job)) {
        ready->run = {};
    }
    return job;
}

std::variant<std::string, Problem> request_of_result(std::string_view result, const std::string& request) {
    const auto text = request_text(request);
    const Json answer = Json::parse(result, nullptr, false);
    std::string structure = structure_of(answer);
    if (structure.empty() && answer.is_object()) structure = structure_of(answer.value("result", Json()));
    auto job =
        structure.empty() ? prepare_job(text ? *text : request) : prepare_structure(text ? *text : request, structure);
    if (auto* problem = std::get_if<Problem>(&job)) return std::move(*problem);
    auto& prepared = std::get<PreparedJob>(job);
    for (const char* place : {"/request_hash", "/result/request_hash"}) {
        const Json::json_pointer hash(place);
        if (!answer.is_object() || !answer.contains(hash) || answer.at(hash) == prepared.request_hash) continue;
        Problem problem{422, "invalid-request", "The request is not valid", {}, {}, {}};
        problem.detail =
            "This is not the request of the result: its request_hash differs. Give the request that was sent, without "
            "further options of the command line, or leave it out.";
        return problem;
    }
    return std::move(prepared.request_json);
}

JobOutcome run_job(const PreparedJob& job, const RunControl& control) { return job.run(job.request_hash, control); }

JobOutcome run_job(const StoredRequest& stored, const RunControl& control) {
    const auto parsed = parse(stored.json);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return failure(*problem);
    const Json& value = std::get<Json>(parsed);
    return with_contract(value, [&](const auto& contract) {
        auto decoded = decode(value, contract);
        const auto* problem = std::get_if<Problem>(&decoded);
        return problem != nullptr ? failure(*problem)
                                  : outcome_of(std::get<0>(std::move(decoded)), stored.hash, control);
    });
}

std::string progress_json(const Progress& progress) {
    Writer out;
    out.begin_object();
    out.key("fraction").number(progress.fraction);
    out.key("stage").text(progress.stage);
    out.key("message").text(progress.message);
    out.key("best");
    if (progress.best) {
        out.begin_object();
        out.key("controller");
        controller_contract().write(progress.best->controller, out);
        for (const auto& [name, figure] :
             {std::pair{"load_IAE", progress.best->load_IAE}, {"Ms", progress.best->Ms}, {"Mt", progress.best->Mt}}) {
            out.key(name).number(figure);
        }
        out.end_object();
    } else {
        out.null();
    }
    out.end_object();
    return out.take();
}

Answer evaluate_call(std::string_view body, const RunControl& control) {
    const auto decoded = read_body(body, evaluate_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<EvaluateRequest>(decoded);

    const auto result = evaluate_all(*request.subject, given(request.controllers), request.evaluate, request.device,
                                     labels_of(request.units), control, request.model ? &*request.model : nullptr,
                                     request.given_steps, request.evaluate.own_step);
    if (!result) return refusal(to_problem(result.error()));
    Writer out;
    evaluate_answer_contract().write(*result, out);
    return {200, out.take()};
}

Answer design_call(std::string_view body, const RunControl& control) {
    auto decoded = read_body(body, design_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    auto result = tuned(std::get<DesignRequest>(std::move(decoded)), control);
    if (!result) return refusal(to_problem(result.error()));
    // The partial result of a search that was stopped is not kept.
    if (result->partial) return refusal(to_problem(Error{ErrorKind::timeout, "", "The design was stopped."}));
    Writer out;
    design_answer_contract().write(*result, out);
    return {200, out.take()};
}

Answer frontier_call(std::string_view body, const RunControl& control) {
    const auto decoded = read_body(body, frontier_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<FrontierRequest>(decoded);

    const auto curve = frontier(*request.subject, frontier_options().read(request.options), control);
    if (!curve) return refusal(to_problem(curve.error()));
    Writer out;
    frontier_contract().write(*curve, out);
    return {200, out.take()};
}

Answer identify_call(std::string_view body, const RunControl& control) {
    const auto decoded = read_body(body, identify_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<IdentifyRequest>(decoded);

    return identified(request.read, request.identify, control);
}

Answer controller_record_call(std::string_view body, const RunControl&) {
    const auto decoded = read_body(body, controller_record_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<ControllerRecordRequest>(decoded);
    auto today =
        recorded_controller(request.read.record, request.device ? &*request.device : nullptr, request.sample_time);
    ControllerRecordAnswer answer;
    if (today) {
        answer.found = std::move(today->found);
        if (auto warning = mode_warning(request.read)) answer.found->warnings.push_back(*std::move(warning));
        if (today->settings)
            answer.typing.emplace(SettingsAnswer{request.device->product, today->settings->settings,
                                                 today->settings->settings, today->settings->realised,
                                                 std::move(today->settings->notes), request.device->context,
                                                 std::move(today->settings_errors)});
        if (!today->not_representable.empty()) answer.not_typed = std::move(today->not_representable);
    } else {
        // A record that does not show the settings is no fault of the request.
        if (today.error().kind != ErrorKind::not_identifiable) return refusal(to_problem(today.error()));
        answer.not_identified = std::move(today.error().message);
    }
    Writer out;
    controller_record_answer_contract().write(answer, out);
    return {200, out.take()};
}

Answer parse_plant_call(std::string_view body) {
    const auto parsed = parse(body);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return refusal(*problem);
    const Json& value = std::get<Json>(parsed);
    auto decoded = decode(value, plant_question_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) {
        const bool unfinished = value.is_object() && value.contains("unfinished") && value["unfinished"] == true;
        if (!unfinished) return refusal(*problem);
        decoded = PlantQuestion{.fault = problem->detail};
    }
    Writer out;
    plant_answer_contract().write(std::get<PlantQuestion>(decoded), out);
    return {200, out.take()};
}

Answer preview_call(std::string_view body) {
    const auto decoded = read_body(body, preview_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<PreviewRequest>(decoded);
    Writer out;
    preview_answer_contract().write(preview_csv(*request.csv, csv_options(request)), out);
    return {200, out.take()};
}

Answer preview_file(std::string_view bytes) {
    Writer out;
    preview_answer_contract().write(preview_csv(bytes, csv_options({})), out);
    return {200, out.take()};
}

Answer relay_call(std::string_view body, const RunControl& control) {
    const auto decoded = read_body(body, relay_request_contract());
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<RelayRequest>(decoded);

    const auto experiment = simulate_relay(*request.plant, request.relay, control);
    if (!experiment) return refusal(to_problem(experiment.error()));
    Writer out;
    relay_answer_contract().write(*experiment, out);
    return {200, out.take()};
}

Answer identify_csv(std::string csv, const CsvRequest& question, const RunControl& control) {
    Reader reader;
    GivenRecord given;
    Units units;
    IdentifyQuestion options;
    {
        const Reader::At at(reader, "record");
        record_contract().read(record_of(question, ""), given, reader);
    }
    {
        const Reader::At at(reader, "units");
        units_contract().read(question.answer_unit.empty() ? Json::object() : Json{{"time", question.answer_unit}},
                              units, reader);
    }
    {
        const Reader::At at(reader, "identify");
        identify_contract().read(identify_json(question), options, reader);
    }
    if (auto problem = reader.problem()) return refusal(*problem);
    given.csv = std::move(csv);
    ReadRecord read;
    {
        const Reader::At at(reader, "record");
        read = resolve(std::move(given), units, reader);
    }
    if (auto problem = reader.problem()) return refusal(*problem);
    return identified(read, options, control);
}

}  // namespace tunewright::api
