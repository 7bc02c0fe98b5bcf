#include "api/contract/structure/predictor_call.h"

#include "engine/number_text.h"

namespace tunewright::api {
namespace {

using structure::PredictorController;
using structure::Rational;

constexpr std::size_t kMaxCoefficients = 8;
constexpr const char* kUnstable = "The loop is not stable.";

const Description<Rational>& rational_contract() {
    static const auto description = [] {
        Description<Rational> d("Rational", "num(s)/den(s), coefficients in descending powers of s.");
        d.field("num", &Rational::num, numbers(1, kMaxCoefficients), "Numerator.", {.required = true})
            .field("den", &Rational::den, numbers(1, kMaxCoefficients), "Denominator.", {.required = true})
            .check([](const Json&, Rational& r, Reader& reader) {
                if (r.den.front() == 0)
                    reader.fault_at("den", "den begins with 0; leave leading zeros out.");
                else if (r.num.size() > r.den.size())
                    reader.fault_at("num",
                                    "num has a higher degree than den, and such a part cannot be built. Give den "
                                    "at least as many coefficients.");
            });
        return d;
    }();
    return description;
}

const Description<PredictorController>& predictor_controller_contract() {
    static const auto description = [] {
        using C = PredictorController;
        Description<C> d("PredictorController", "u = C [r - Gm u - F (y - Gm e^(-Lm s) u)].");
        d.field("C", &C::C, object(rational_contract()), "The controller of the model without dead time.",
                {.required = true})
            .field("F", &C::F, object(rational_contract()), "The filter of the prediction's error; F(0) = 1.",
                   {.required = true})
            .check([](const Json&, C& c, Reader& reader) {
                if (c.F.num.back() != c.F.den.back())
                    reader.fault_at("F",
                                    "F(0) is not 1, so the loop would keep an error. Make the last coefficients of "
                                    "num and den equal.");
            });
        return d;
    }();
    return description;
}

void check_predictor(const Json& value, PredictorRequest& request, Reader& reader) {
    const char* from = request.model ? "model" : "plant";
    const auto model = structure::model_of(request.model ? *request.model : *request.plant);
    if (!model)
        return reader.fault_at(from, request.model
                                         ? "model must be of first order, or an integrator, without zeros."
                                         : "The plant is not of first order, nor an integrator. Give such a model of "
                                           "it as model, such as \"2 e^(-30s)/(10s+1)\".");
    if (!(model->L > 0))
        return reader.fault_at(from, std::string(from) + " has no dead time; a predictor needs one above 0.");
    request.of_model = *model;
    if (!request.controller) return;
    request.controller->model = *model;
    for (const char* name : {"kind", "Ms", "dead_time_error"})
        if (value.contains(name))
            reader.fault_at(name,
                            std::string(name) + " belongs to a design, and controller is given. Remove one of them.");
}

void write_model(const structure::PredictorModel& model, Writer& out) {
    out.begin_object();
    out.key("K").number(model.K);
    if (!model.integrating) out.key("T").number(model.T);
    out.key("L").number(model.L);
    out.end_object();
}

Json model_schema(SchemaBook&) {
    const Json number{{"type", "number"}};
    return {
        {"type", "object"}, {"properties", {{"K", number}, {"T", number}, {"L", number}}}, {"required", {"K", "L"}}};
}

const Description<structure::PredictorFigures>& predictor_figures_contract() {
    static const auto description = [] {
        using F = structure::PredictorFigures;
        Description<F> d("PredictorRobustness", "Figures of the loop over frequency.");
        d.field("stable", &F::stable, only_answered(boolean()), "The loop is stable.")
            .field(
                "controller_stable", {}, [](const F& f, Writer& out) { out.boolean(f.controller_unstable_poles == 0); },
                boolean().schema, "The controller by itself is stable.")
            .field("Ms", &F::Ms, peak_figure(), "max |S|.")
            .field("Mt", &F::Mt, peak_figure(), "max |T|.")
            .field("dead_time_up", &F::dead_time_up, figure(),
                   "By this much the dead time may rise: the loop stays stable at every smaller error.",
                   {.unit = "time"})
            .field("dead_time_down", &F::dead_time_down, figure(), "By this much it may fall.", {.unit = "time"})
            .why_null(kUnstable);
        return d;
    }();
    return description;
}

StepView view_of(const OrReason<structure::StepFigures>& f, bool setpoint) {
    if (!f) return {0.0, 0.0, 0, 0, f.why};
    return {f->IAE, f->IE, setpoint ? f->overshoot : f->peak, f->TV, ""};
}

}  // namespace

const Description<PredictorRequest>& predictor_request_contract() {
    static const auto description = [] {
        using R = PredictorRequest;
        using D = structure::PredictorDesign;
        using enum structure::PredictorKind;
        const auto kind = choice<structure::PredictorKind>(
            {{"smith", smith}, {"filtered_smith", filtered_smith}, {"predictive_pi", predictive_pi}});
        const auto Ms = number({.exclusive_minimum = 1, .maximum = structure::kMaxPredictorMs});
        const auto error = maybe(number({.exclusive_minimum = 0, .maximum = 1}));
        Description<R> d("PredictorRequest", "A loop with a long dead time.");
        add_structure_members(d, "predictor", 1);
        d.field("plant", &R::plant, linear_plant(), "The plant.", {.required = true})
            .field("model", &R::model, linear_plant(),
                   "The model in the controller, of first order or an integrator; default: the plant.")
            .field(
                "kind", [kind](const Json& value, R& r, Reader& reader) { kind.read(value, r.design.kind, reader); },
                {}, kind.schema,
                "smith (default); filtered_smith: also for integrating and unstable plants; predictive_pi: two "
                "settings, no limit is used.")
            .field(
                "Ms", [Ms](const Json& value, R& r, Reader& reader) { Ms.read(value, r.design.Ms, reader); }, {},
                Ms.schema, "Limit on max |S| of the predictor; default " + tunewright::text(limits::kDefaultMs) + ".")
            .field(
                "dead_time_error",
                [error](const Json& value, R& r, Reader& reader) {
                    error.read(value, r.design.*(&D::dead_time_error), reader);
                },
                {}, error.schema, "Share of the dead time by which it may be wrong either way.")
            .field("controller", &R::controller, maybe(object(predictor_controller_contract())),
                   "A controller to judge, in place of a design.")
            .check(check_predictor)
            .example({{"plant", "5.6 e^(-93.9s)/(40.2s+1)"}, {"Ms", 1.6}, {"dead_time_error", 0.25}});
        return d;
    }();
    return description;
}

const Description<PredictorAnswer>& predictor_answer_contract() {
    static const auto description = [] {
        using A = PredictorAnswer;
        Description<A> d("PredictorAnswer", "A predictor, its figures, and the PID of the same Ms.");
        add_structure_name(d, "predictor");
        const auto setting = [](double PredictorController::*member) {
            return [member](const A& a, Writer& out) { out.number(a.controller.*member); };
        };
        const auto unused = [](double PredictorController::*member) {
            return [member](const A& a) { return a.controller.*member == 0; };
        };
        d.field(
             "controller", {},
             [](const A& a, Writer& out) { predictor_controller_contract().write(a.controller, out); },
             object(predictor_controller_contract()).schema, "C and F.")
            .field(
                "model", {}, [](const A& a, Writer& out) { write_model(a.controller.model, out); }, model_schema,
                "The model K e^(-Ls)/(T s + 1) in it; without T: K e^(-Ls)/s.")
            .field("lambda", {}, setting(&PredictorController::lambda), number().schema,
                   "Time constant of the response to the set point, without the dead time.", {.unit = "time"},
                   unused(&PredictorController::lambda))
            .field("Tf", {}, setting(&PredictorController::Tf), number().schema,
                   "Filtered predictor: double time constant of its response to loads.", {.unit = "time"},
                   unused(&PredictorController::Tf))
            .field("beta", {}, setting(&PredictorController::beta), number().schema,
                   "Filtered predictor: the zero that cancels the model's pole in this response.", {.unit = "time"},
                   unused(&PredictorController::beta))
            .field("robustness", &A::figures, answer(predictor_figures_contract()), "Over frequency.")
            .field(
                "load", {},
                [](const A& a, Writer& out) { step_view_contract().write(view_of(a.figures.load, false), out); },
                object(step_view_contract()).schema, "After a unit load at the plant's input.")
            .field(
                "setpoint", {},
                [](const A& a, Writer& out) { step_view_contract().write(view_of(a.figures.setpoint, true), out); },
                object(step_view_contract()).schema, "After a unit step of the set point.")
            .field("pid", &A::pid, or_reason(ideal_controller()),
                   "The robust PID with the Ms of the predictor as its limit.")
            .field("pid_IAE", &A::pid_IAE, figure(), "IAE of a unit load with it.", {.unit = "y time/u"})
            .why_null("Not found.");
        add_answer_members(d);
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
