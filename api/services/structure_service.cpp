#include "api/services/structure_service.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/describe/body.h"
#include "api/services/job_outcome.h"
#include "api/services/structure_records.h"
#include "api/services/structure_sampled.h"
#include "engine/structure/drawing/drawing.h"

namespace tunewright::api {
namespace {

using structure::CascadeControllers;
using structure::CascadeResult;

Error stopped() { return {ErrorKind::cancelled, "", "The design was stopped."}; }

/// Adds the settings of the user's product for the controller number `place`.
void add_settings(const StructureRequest& request, const std::string& loop, std::size_t place,
                  const IdealPid& controller, StructureAnswer& out) {
    if (request.devices.empty()) return;
    const device::DeviceModel& device = request.devices[request.devices.size() == 1 ? 0 : place];
    if (device.product == nullptr) return;
    auto fitted = device::fit(device, controller);
    out.settings.push_back({loop, fitted ? OrReason<device::Fitted>(std::move(*fitted))
                                         : OrReason<device::Fitted>({}, fitted.error().message)});
}

Expected<CascadeResult> given_cascade(const CascadeRequest& request, const CascadeControllers& controllers) {
    auto figures = judge_cascade(request.plants(), controllers);
    if (!figures) return figures.error();
    return CascadeResult{controllers, std::move(*figures), false};
}

/// Designed, or with an outer controller that is given: then only the inner one is designed, if it is not given too.
Expected<CascadeResult> cascade_of(const CascadeRequest& request, const RunControl& control) {
    if (!request.outer.controller) return design_cascade(request.plants(), request.design(), control);
    if (request.inner.controller) return given_cascade(request, {*request.inner.controller, *request.outer.controller});
    auto inner = robust_settings(*request.inner.plant, request.inner.tune, control);
    if (!inner) return Error{inner.error().kind, "inner/" + inner.error().where, inner.error().message};
    return given_cascade(request, {*inner, *request.outer.controller});
}

Expected<CascadeAnswer> answered(const CascadeRequest& request, const RunControl& control) {
    auto result = cascade_of(request, control);
    if (!result) return result.error();
    CascadeAnswer out;
    out.result = std::move(*result);
    out.partial = out.result.partial;
    out.limit_valve = request.design().valve_limit();
    if (request.compare_single) {
        auto single = design_single_loop(request.plants(), request.outer.tune, control);
        if (single)
            out.single = std::move(*single);
        else
            out.single.why = single.error().message;
    } else {
        out.single.why = "compare_single is false.";
    }
    if (request.baseline) {
        auto today = judge_cascade(request.plants(), {*request.baseline->inner, *request.baseline->outer});
        if (!today) return Error{today.error().kind, "baseline", today.error().message};
        out.baseline = std::move(*today);
    }
    out.verdict = conclusions_on(out.result.figures, request.design(), out.single ? &*out.single : nullptr);
    const structure::CascadeDesign limits = request.design();
    std::optional<CascadeControllers> today;
    if (request.baseline) today = {*request.baseline->inner, *request.baseline->outer};
    out.drawing = draw(request.plants(), out.result.controllers, limits, out.single ? &*out.single : nullptr,
                       today ? &*today : nullptr, request.points);
    add_settings(request, "inner", 0, out.result.controllers.inner, out);
    add_settings(request, "outer", 1, out.result.controllers.outer, out);
    return out;
}

Expected<LevelAnswer> answered(const LevelRequest& request, const RunControl&) {
    auto result = design_level(request.problem);
    if (!result) return result.error();
    LevelAnswer out;
    out.result = std::move(*result);
    out.verdict = conclusions_on(out.result, request.problem);
    const structure::LevelDesign& design = out.result.design;
    out.gap = request.problem.gap;
    out.drawing = draw(request.problem, design, request.points);
    add_settings(request, "level", 0, IdealPid{.Kp = -design.Kc, .Ti = design.Ti}, out);
    return out;
}

/// An error of the loop's design, in the member that has it; the plant is next to that member.
Error below_unless_plant(const char* member, Error error) {
    if (!error.where.starts_with("plant")) error.where = member + ("/" + error.where);
    return error;
}

Expected<FeedforwardAnswer> answered(const FeedforwardRequest& request, const RunControl& control) {
    FeedforwardAnswer out;
    if (request.feedback.controller) {
        out.feedback = *request.feedback.controller;
    } else {
        const auto settings = robust_settings(*request.plant, *request.feedback.tune, control);
        if (!settings) return below_unless_plant("feedback", settings.error());
        out.feedback = *settings;
    }
    const structure::FeedforwardProblem problem{.plant = *request.plant,
                                                .disturbance = *request.disturbance,
                                                .feedback = out.feedback,
                                                .jump = request.feedforward.jump,
                                                .given = request.controller,
                                                .wanted = request.feedforward.method,
                                                .wrong = request.uncertainty};
    auto result = design_feedforward(problem, control);
    if (!result) return result.error();
    out.result = std::move(*result);
    out.partial = out.result.partial;
    out.chosen = request.controller ? structure::FeedforwardKind::given : problem.wanted;
    out.verdict = conclusions_on(out.result, problem);
    out.drawing =
        draw(problem, out.result,
             request.feedback.tune ? std::optional<double>(request.feedback.tune->Ms) : std::nullopt, request.points);
    add_settings(request, "feedback", 0, out.feedback, out);
    return out;
}

Expected<PredictorAnswer> designed_predictor(const PredictorRequest& request, const RunControl& control) {
    auto result = design_predictor(request.of_model, *request.plant, request.design, control);
    if (!result) return result.error();
    if (control.stop.stop_requested()) return stopped();
    PredictorAnswer out;
    out.controller = std::move(result->controller);
    out.figures = std::move(result->figures);
    out.pid = {result->pid, result->pid_IAE.why};
    out.pid_IAE = std::move(result->pid_IAE);
    out.verdict = conclusions_on(out.figures, out.pid_IAE, result->limited_by_dead_time, request.plant->dead_time());
    return out;
}

Expected<PredictorAnswer> given_predictor(const PredictorRequest& request) {
    auto figures = judge_predictor(*request.plant, *request.controller);
    if (!figures) return figures.error();
    PredictorAnswer out;
    out.controller = *request.controller;
    out.figures = std::move(*figures);
    out.pid.why = out.pid_IAE.why = "A given controller is not compared.";
    out.verdict = conclusions_on(out.figures, out.pid_IAE, false, request.plant->dead_time());
    return out;
}

Expected<PredictorAnswer> answered(const PredictorRequest& request, const RunControl& control) {
    auto out = request.controller ? given_predictor(request) : designed_predictor(request, control);
    if (!out) return out;
    const auto limit = request.controller ? std::nullopt : std::optional<double>(request.design.Ms);
    out->drawing = draw(*request.plant, out->controller, limit, out->pid ? &*out->pid : nullptr, request.points);
    if (out->pid) add_settings(request, "pid", 0, *out->pid, *out);
    return out;
}

std::vector<IdealPid> known(const std::vector<std::optional<IdealPid>>& given) {
    std::vector<IdealPid> out;
    for (const auto& one : given) out.push_back(*one);
    return out;
}

/// Without a value of its own where the loops are not stable.
Figure cost_of(const structure::InteractionFigures& figures, const InteractionRequest& request) {
    if (!figures.stable) return {};
    double sum = 0;
    for (const auto& row : figures.IAE_load)
        for (std::size_t i = 0; i < row.size(); ++i) sum += request.weight(i) * row[i];
    return finite_or(sum, structure::kRestsElsewhere);
}

/// The place of the requested pairing. Without one given controllers act on the input of their own number, and a design
/// takes the best.
std::size_t chosen_pairing(const structure::GainAnalysis& gains, const InteractionRequest& request) {
    const bool given = !request.controllers.given.empty() || request.baseline;
    if (!request.pairing && !given) return 0;
    std::vector<int> wanted(request.plant.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = request.pairing ? (*request.pairing)[i] - 1 : int(i);
    return std::size_t(std::ranges::find(gains.pairings, wanted, &structure::Pairing::input_of) -
                       gains.pairings.begin());
}

/// The figures of controllers for comparison, or the reason why there are none.
Expected<ComparedControllers> compared(const char* name, std::vector<IdealPid> controllers, std::string why,
                                       const structure::PlantMatrix& plants, const InteractionRequest& request) {
    ComparedControllers out{
        .name = name, .controllers = std::move(controllers), .figures = {}, .cost = {}, .why = std::move(why)};
    if (out.controllers.empty()) return out;
    auto figures = structure::judge_interaction(plants, out.controllers);
    if (!figures) return Error{figures.error().kind, name, figures.error().message};
    out.figures = std::move(*figures);
    out.cost = cost_of(out.figures, request);
    return out;
}

Expected<InteractionAnswer> answered(const InteractionRequest& request, const RunControl& control) {
    auto gains = structure::analyse_gains(request.plant);
    if (!gains) return gains.error();
    InteractionAnswer out;
    out.gains = std::move(*gains);
    out.chosen = chosen_pairing(out.gains, request);
    const auto plants = structure::paired(request.plant, out.gains.pairings[out.chosen].input_of);
    OrReason<structure::BltSettings> blt;
    std::vector<IdealPid> detuned;
    if (request.controllers.given.empty()) {
        auto result = structure::design_interaction(plants,
                                                    {.derivative = request.controllers.kind == ControllerKind::PID,
                                                     .mu = request.limit.mu,
                                                     .weight = request.weights.y},
                                                    control);
        if (!result) return result.error();
        out.partial = result->partial;
        out.controllers = std::move(result->controllers);
        out.figures = std::move(result->figures);
        blt = std::move(result->blt);
        detuned = std::move(result->detuned);
    } else {
        out.controllers = known(request.controllers.given);
        auto figures = structure::judge_interaction(plants, out.controllers);
        if (!figures) return figures.error();
        out.figures = std::move(*figures);
        blt.why = "Nothing was designed.";
    }
    out.cost = cost_of(out.figures, request);
    out.F = blt ? Figure(blt->F) : no_figure(blt.why);
    double blt_cost = std::numeric_limits<double>::infinity();
    for (const std::string& name : request.compare) {
        const bool is_blt = name == "blt";
        auto one =
            compared(is_blt ? "blt" : "detuned", is_blt ? (blt ? blt->controllers : std::vector<IdealPid>{}) : detuned,
                     is_blt            ? blt.why
                     : detuned.empty() ? "None keeps the limit."
                                       : "",
                     plants, request);
        if (!one) return one.error();
        if (is_blt) blt_cost = one->cost.value_or(blt_cost);
        out.compared.push_back(std::move(*one));
    }
    if (request.baseline) {
        auto today = compared("baseline", known(request.baseline->given), "", plants, request);
        if (!today) return today.error();
        out.compared.push_back(std::move(*today));
    }
    out.verdict = conclusions_on(out.figures, out.gains, out.chosen, request.limit.mu,
                                 out.cost.value_or(std::numeric_limits<double>::infinity()), blt_cost);
    structure::NamedControllers all{{"design", out.controllers}};
    for (const ComparedControllers& other : out.compared)
        if (!other.controllers.empty()) all.emplace_back(other.name, other.controllers);
    out.drawing = structure::draw(plants, all, request.limit.mu, request.points);
    for (std::size_t i = 0; i < out.controllers.size(); ++i)
        add_settings(request, "loop_" + std::to_string(i + 1), i, out.controllers[i], out);
    return out;
}

/// The whole answer: with models in the place of plants where the request has records, and with a run of the program.
template <class Request, class Result>
std::variant<Result, Problem> whole_answer(const Request& given, const Description<Result>& contract,
                                           const RunControl& control) {
    auto models = models_of(given, control);
    if (!models) return to_problem(models.error());
    Request request = given;
    if (auto error = take_models(*models, request)) return to_problem(*error);
    auto result = answered(request, control);
    if (!result) return to_problem(at_source(result.error(), given));
    result->models = std::move(*models);
    result->units = request.units;
    if (!request.sampled || result->partial) return std::move(*result);
    // The program needs the settings alone.
    structure::StructureDrawing drawing = std::exchange(result->drawing, {});
    Writer text;
    contract.write(*result, text);
    result->drawing = std::move(drawing);
    auto view = run_program(request, Json::parse(text.view()), sampled_plants(request, *result), control);
    if (auto* problem = std::get_if<Problem>(&view)) return std::move(*problem);
    result->sampled = std::move(std::get<SampledView>(view));
    return std::move(*result);
}

/// JobOutline of the document.
template <class Request>
std::string outline_of(const Request& request, const char* structure, const StructureAnswer& answer) {
    Writer out;
    out.begin_object();
    if (request.units) {
        out.key("units");
        units_contract().write(*request.units, out);
    }
    out.key("method").text(structure);
    out.key("structure").begin_object();
    out.key("verdict").begin_array();
    for (const structure::Conclusion& one : answer.verdict) out.text(to_string(one.code));
    out.end_array();
    out.end_object();
    out.end_object();
    return out.take();
}

template <class Request, class Result>
Answer call(std::string_view body, const Description<Request>& contract, const Description<Result>& result_contract,
            const RunControl& control) {
    const auto decoded = read_body(body, contract);
    if (const auto* problem = std::get_if<Problem>(&decoded)) return refusal(*problem);
    const auto& request = std::get<Request>(decoded);
    auto made = whole_answer(request, result_contract, control);
    if (const auto* problem = std::get_if<Problem>(&made)) return refusal(*problem);
    auto& result = std::get<Result>(made);
    // The partial result of a search that was stopped is not kept.
    if (result.partial) return refusal(to_problem(stopped()));
    Writer out;
    result_contract.write(result, out);
    return {200, out.take()};
}

template <class Request, class Result>
JobOutcome outcome(const Request& request, const char* structure, const Description<Result>& result_contract,
                   std::string_view hash, const RunControl& control) {
    auto made = whole_answer(request, result_contract, control);
    if (const auto* problem = std::get_if<Problem>(&made))
        return without_result(structure, *problem, control.stop.stop_requested());
    auto& result = std::get<Result>(made);
    result.request_hash = hash;
    Writer out;
    result_contract.write(result, out);
    return with_result(structure, result.partial, outline_of(request, structure, result), out.take());
}

}  // namespace

Answer cascade_call(std::string_view body, const RunControl& control) {
    return call(body, cascade_request_contract(), cascade_answer_contract(), control);
}

Answer level_call(std::string_view body, const RunControl& control) {
    return call(body, level_request_contract(), level_answer_contract(), control);
}

Answer feedforward_call(std::string_view body, const RunControl& control) {
    return call(body, feedforward_request_contract(), feedforward_answer_contract(), control);
}

Answer interaction_call(std::string_view body, const RunControl& control) {
    return call(body, interaction_request_contract(), interaction_answer_contract(), control);
}

Answer predictor_call(std::string_view body, const RunControl& control) {
    return call(body, predictor_request_contract(), predictor_answer_contract(), control);
}

JobOutcome structure_outcome(const CascadeRequest& request, std::string_view hash, const RunControl& control) {
    return outcome(request, "cascade", cascade_answer_contract(), hash, control);
}

JobOutcome structure_outcome(const LevelRequest& request, std::string_view hash, const RunControl& control) {
    return outcome(request, "level", level_answer_contract(), hash, control);
}

JobOutcome structure_outcome(const FeedforwardRequest& request, std::string_view hash, const RunControl& control) {
    return outcome(request, "feedforward", feedforward_answer_contract(), hash, control);
}

JobOutcome structure_outcome(const InteractionRequest& request, std::string_view hash, const RunControl& control) {
    return outcome(request, "interaction", interaction_answer_contract(), hash, control);
}

JobOutcome structure_outcome(const PredictorRequest& request, std::string_view hash, const RunControl& control) {
    return outcome(request, "predictor", predictor_answer_contract(), hash, control);
}

}  // namespace tunewright::api
