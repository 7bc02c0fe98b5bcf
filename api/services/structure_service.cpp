#include "api/services/structure_service.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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

constexpr const char* kNothingDesigned = "Nothing was designed.";

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

/// The data with which a request's controllers are designed and judged.
struct InteractionTask {
    const InteractionRequest& request;
    const structure::PlantMatrix& plants;
    const RunControl& control;

    bool designs() const { return request.controllers.given.empty(); }
    Expected<structure::InteractionResult> design(const structure::Decoupling& decoupling) const {
        return structure::design_interaction(plants,
                                             {.derivative = request.controllers.kind == ControllerKind::PID,
                                              .mu = request.limit.mu,
                                              .weight = request.weights.y,
                                              .decoupling = decoupling},
                                             control);
    }
};

/// The figures of controllers for comparison, or the reason why there are none.
Expected<ComparedControllers> compared(const char* name, std::vector<IdealPid> controllers, std::string why,
                                       const InteractionTask& task) {
    ComparedControllers out{
        .name = name, .controllers = std::move(controllers), .figures = {}, .cost = {}, .why = std::move(why)};
    if (out.controllers.empty()) return out;
    auto figures = structure::judge_interaction(task.plants, out.controllers);
    if (!figures) return Error{figures.error().kind, name, figures.error().message};
    out.figures = std::move(*figures);
    out.cost = cost_of(out.figures, task.request);
    return out;
}

/// `cost`: of stable loops with the decoupler, else empty.
DecouplingView decoupling_view(structure::Decoupler decoupler, const std::vector<IdealPid>& controllers,
                               const Figure& cost, const Figure& cost_without, const InteractionTask& task) {
    DecouplingView out{.decoupler = std::move(decoupler), .gain = cost_without, .wrong = {}};
    if (cost_without) out.gain = cost ? Figure(*cost_without / *cost) : Figure();
    out.wrong = structure::with_wrong_gains(task.plants, controllers, out.decoupler.elements);
    return out;
}

/// Controllers that are designed with a decoupler, or the reason why there are none.
Expected<ComparedControllers> compared_decoupler(const std::string& name, const Figure& cost_without,
                                                 const InteractionTask& task) {
    using enum structure::DecouplerKind;
    ComparedControllers out{.name = name, .controllers = {}, .figures = {}, .cost = {}, .why = {}};
    auto decoupler = structure::design_decoupler(task.plants, name == "static_decoupler" ? static_gains : simplified);
    if (!task.designs() || !decoupler) {
        out.why = task.designs() ? decoupler.error().message : kNothingDesigned;
        return out;
    }
    auto result = task.design(decoupler->elements);
    if (!result && result.error().kind == ErrorKind::cancelled) return result.error();
    if (!result) {
        out.why = result.error().message;
        return out;
    }
    if (result->partial) return stopped();
    out.controllers = std::move(result->controllers);
    out.figures = std::move(result->figures);
    out.cost = cost_of(out.figures, task.request);
    out.decoupling = decoupling_view(std::move(*decoupler), out.controllers, out.cost, cost_without, task);
    return out;
}

/// The design without a decoupler, with what is compared with it.
struct PlainDesign {
    OrReason<structure::InteractionResult> result = {std::nullopt, kNothingDesigned};
    OrReason<structure::BltSettings> blt = {std::nullopt, kNothingDesigned};
    Figure cost = no_figure(kNothingDesigned);
};

/// It fails only if it is the design that was asked for, or was stopped.
Expected<PlainDesign> plain_design(const InteractionTask& task) {
    PlainDesign out;
    if (!task.designs()) return out;
    auto result = task.design({});
    if (!result &&
        (task.request.decoupler == structure::DecouplerKind::none || result.error().kind == ErrorKind::cancelled))
        return result.error();
    if (!result) {
        const std::string& why = result.error().message;
        return PlainDesign{{std::nullopt, why}, {std::nullopt, why}, no_figure(why)};
    }
    out.cost = cost_of(result->figures, task.request);
    out.blt = result->blt;
    out.result = std::move(*result);
    return out;
}

/// The controllers of the answer, designed or given, with their figures.
std::optional<Error> add_controllers(const PlainDesign& plain, const InteractionTask& task, InteractionAnswer& out) {
    auto decoupler = structure::design_decoupler(task.plants, task.request.decoupler);
    if (!decoupler) return decoupler.error();
    const bool decoupled = decoupler->kind != structure::DecouplerKind::none;
    if (task.designs()) {
        auto result =
            decoupled ? task.design(decoupler->elements) : Expected<structure::InteractionResult>(*plain.result);
        if (!result) return result.error();
        out.partial = result->partial || (plain.result && plain.result->partial);
        out.controllers = std::move(result->controllers);
        out.figures = std::move(result->figures);
    } else {
        out.controllers = known(task.request.controllers.given);
        auto figures = structure::judge_interaction(task.plants, out.controllers, decoupler->elements);
        if (!figures) return figures.error();
        out.figures = std::move(*figures);
    }
    out.cost = cost_of(out.figures, task.request);
    if (decoupled) out.decoupling = decoupling_view(std::move(*decoupler), out.controllers, out.cost, plain.cost, task);
    return std::nullopt;
}

/// The controllers with which the request compares.
std::optional<Error> add_compared(const PlainDesign& plain, const InteractionTask& task, InteractionAnswer& out) {
    const auto add = [&](Expected<ComparedControllers> one) -> std::optional<Error> {
        if (!one) return one.error();
        out.compared.push_back(std::move(*one));
        return std::nullopt;
    };
    if (task.designs() && out.decoupling) {
        ComparedControllers without{
            .name = "no_decoupler", .controllers = {}, .figures = {}, .cost = {}, .why = plain.result.why};
        if (plain.result) {
            without.controllers = plain.result->controllers;
            without.figures = plain.result->figures;
            without.cost = plain.cost;
        }
        out.compared.push_back(std::move(without));
    }
    for (const std::string& name : task.request.compare) {
        std::optional<Error> error;
        if (name == "blt")
            error =
                add(compared("blt", plain.blt ? plain.blt->controllers : std::vector<IdealPid>{}, plain.blt.why, task));
        else if (name == "detuned")
            error = add(compared("detuned", plain.result ? plain.result->detuned : std::vector<IdealPid>{},
                                 !plain.result                   ? plain.result.why
                                 : plain.result->detuned.empty() ? "None keeps the limit."
                                                                 : "",
                                 task));
        else
            error = add(compared_decoupler(name, plain.cost, task));
        if (error) return error;
    }
    if (!task.request.baseline) return std::nullopt;
    return add(compared("baseline", known(task.request.baseline->given), "", task));
}

/// Conclusions about the answer's decoupler, or about the best of the compared ones.
void add_decoupler_conclusions(InteractionAnswer& out) {
    const DecouplingView* view = out.decoupling ? &*out.decoupling : nullptr;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    double cost = out.cost.value_or(kUnknown), mu = out.figures.mu;
    for (const ComparedControllers& other : out.compared) {
        const double its = other.cost.value_or(kUnknown);
        if (out.decoupling || !other.decoupling || (view != nullptr && its >= cost)) continue;
        view = &*other.decoupling;
        cost = its;
        mu = other.figures.mu;
    }
    if (view == nullptr || (out.decoupling && !out.figures.stable)) return;
    double largest = 0;
    for (const auto& row : out.gains.relative)
        for (const double one : row) largest = std::max(largest, std::abs(one));
    std::ranges::move(conclusions_on_decoupler(view->gain, mu, view->wrong, largest), std::back_inserter(out.verdict));
}

Expected<InteractionAnswer> answered(const InteractionRequest& request, const RunControl& control) {
    auto gains = structure::analyse_gains(request.plant);
    if (!gains) return gains.error();
    InteractionAnswer out;
    out.gains = std::move(*gains);
    out.chosen = chosen_pairing(out.gains, request);
    const auto plants = structure::paired(request.plant, out.gains.pairings[out.chosen].input_of);
    const InteractionTask task{request, plants, control};
    const auto plain = plain_design(task);
    if (!plain) return plain.error();
    if (auto error = add_controllers(*plain, task, out)) return *error;
    if (auto error = add_compared(*plain, task, out)) return *error;
    out.F = plain->blt ? Figure(plain->blt->F) : no_figure(plain->blt.why);
    const auto blt = std::ranges::find(out.compared, "blt", &ComparedControllers::name);
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    out.verdict = conclusions_on(out.figures, out.gains, out.chosen, request.limit.mu, out.cost.value_or(kUnknown),
                                 blt != out.compared.end() ? blt->cost.value_or(kUnknown) : kUnknown);
    add_decoupler_conclusions(out);
    const auto elements = [](const std::optional<DecouplingView>& view) {
        return view ? view->decoupler.elements : structure::Decoupling{};
    };
    std::vector<structure::NamedControllers> all{{"design", out.controllers, elements(out.decoupling)}};
    for (const ComparedControllers& other : out.compared)
        if (!other.controllers.empty()) all.push_back({other.name, other.controllers, elements(other.decoupling)});
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
