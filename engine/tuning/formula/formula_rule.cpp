#include "engine/tuning/formula/formula_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/number_text.h"
#include "engine/plant/expression/program_builder.h"
#include "engine/plant/expression/program_run.h"
#include "engine/plant/expression/tokens.h"
#include "engine/tuning/method/ultimate_rule.h"

namespace tunewright {
namespace {

constexpr const char* kNames = "K, T, T2, L, Kv, tau, Ku and Pu";

bool is_of_ultimate_point(const std::string& name) { return name == "Ku" || name == "Pu"; }

/// The figures of one plant, computed when a formula asks for them.
class Figures {
public:
    Figures(const TuningProblem& problem, const FormulaOptions& options, bool with_second_lag)
        : problem_(problem), options_(options) {
        if (with_second_lag) request_.order = ReducedOrder::second;
        if (!with_second_lag) request_.preferred = ReductionMethod::tangent;
    }

    NameMeaning meaning(const std::string& name) {
        const auto found = is_of_ultimate_point(name) ? of_ultimate_point(name) : of_model(name);
        if (found) return *found;
        if (error_) return UnknownName{error_->message};
        return UnknownName{quoted(name) + " is not a figure of the model; a formula may use " + kNames + "."};
    }
    const std::optional<Error>& error() const { return error_; }
    const std::optional<ReducedModel>& model() const { return model_; }

private:
    std::optional<double> of_ultimate_point(const std::string& name) {
        const auto point = chosen_ultimate_point(problem_, {});
        if (!point) {
            error_ = point.error();
            return std::nullopt;
        }
        return name == "Ku" ? point->Ku : point->Pu;
    }

    std::optional<double> of_model(const std::string& name) {
        if (!model_) {
            auto reduced = rule_model(problem_, options_.reduction, request_);
            if (!reduced) {
                error_ = reduced.error();
                return std::nullopt;
            }
            model_ = *reduced;
        }
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        const ReducedModel& model = *model_;
        const bool integrates = model.integrators > 0;
        if (name == "K") return integrates ? kInfinity : model.K;
        if (name == "T") return integrates ? kInfinity : model.T1;
        if (name == "T2") return integrates ? model.T1 : model.T2;
        if (name == "L") return model.L;
        if (name == "Kv") return integrates ? model.K : model.K / model.T1;
        if (name == "tau") return normalised_dead_time(model);
        return std::nullopt;
    }

    const TuningProblem& problem_;
    const FormulaOptions& options_;
    ReductionRequest request_;
    std::optional<ReducedModel> model_;
    std::optional<Error> error_;
};

struct Formula {
    const char* parameter;
    SyntaxTree tree;
};

/// The formulas that are given.
Expected<std::vector<Formula>> parsed(const FormulaOptions& options) {
    if (options.Kp.empty())
        return Error{ErrorKind::invalid_argument, "Kp", "Give a formula for Kp, such as T/(2*K*L)."};
    std::vector<Formula> out;
    for (const auto& [name, formula] : {std::pair{"Kp", &options.Kp}, {"Ti", &options.Ti}, {"Td", &options.Td}}) {
        if (formula->empty()) continue;
        auto tree = parse_expression(*formula);
        if (!tree) return Error{ErrorKind::invalid_argument, name, tree.error().message};
        out.push_back({name, std::move(*tree)});
    }
    return out;
}

Expected<double> value_of(const Formula& formula, Figures& figures) {
    const std::string parameter = formula.parameter;
    const auto at = [&](ErrorKind kind, const std::string& message) { return Error{kind, parameter, message}; };
    ProgramBuilder builder({});
    const auto fault = builder.add_output(formula.tree, "formula of " + parameter,
                                          [&](const std::string& name) { return figures.meaning(name); });
    if (fault && figures.error()) return *figures.error();
    if (fault) return at(ErrorKind::invalid_argument, fault->message);
    const Program program = builder.finish();
    double value = 0;
    program.evaluate<double>({}, std::span(&value, 1));
    if (std::isfinite(value)) return value;
    std::string why = program.fault<double>({}, 1);
    if (why.empty()) why = "Its value is not finite";
    return at(ErrorKind::unsupported, why + ". With an integrator K and T are infinite; use Kv, which is K/T.");
}

Error below_zero(const std::string& name, double value, const char* allowed) {
    return {ErrorKind::unsupported, name,
            "The formula gives " + name + " = " + text(value) + " for this plant; it must be " + allowed + "."};
}

Expected<TunedController> tune_formula(const TuningProblem& problem, const FormulaOptions& options) {
    const auto formulas = parsed(options);
    if (!formulas) return formulas.error();
    const bool with_second_lag = std::ranges::any_of(*formulas, [](const Formula& formula) {
        return std::ranges::find(formula.tree.names, "T2") != formula.tree.names.end();
    });
    Figures figures(problem, options, with_second_lag);
    IdealPid pid;
    for (const Formula& formula : *formulas) {
        const auto value = value_of(formula, figures);
        if (!value) return value.error();
        const std::string name = formula.parameter;
        if (name == "Ti" && !(*value > 0)) return below_zero(name, *value, "above 0");
        if (name == "Td" && *value < 0) return below_zero(name, *value, "0 or more");
        (name == "Kp" ? pid.Kp : name == "Ti" ? pid.Ti : pid.Td) = *value;
    }
    pid.filter = chosen_filter(options.filter, FilterType::measurement_second_order, pid.Td);
    if (!figures.model()) return rule_answer(pid, {});
    return rule_answer(problem, *figures.model(), pid, {});
}

}  // namespace

TuningMethod formula_method() {
    TuningMethod method;
    method.id = "formula";
    method.title = "Your own formula";
    method.formula = "Kp, Ti, Td: as the request writes them";
    method.source = "the request";
    method.needs = "any linear plant that has the figures of the formulas (others are reduced)";
    method.validity = "as far as the formulas go";
    method.compared = false;
    OptionSet<FormulaOptions> options;
    options.field(&FormulaOptions::Kp, "Kp", "Formula of Kp, such as 0.5*T/(K*L).", {.unit = "u/y", .required = true});
    options.field(&FormulaOptions::Ti, "Ti",
                  "Formula of Ti, such as min(T, 8*L). Without it there is no integral action.", {.unit = "time"});
    options.field(&FormulaOptions::Td, "Td", "Formula of Td. Without it there is no derivative action.",
                  {.unit = "time"});
    options.main({"Kp", "Ti", "Td"});
    add_reduction(options, "the tangent; with T2 the half rule.");
    add_filter(options, "of second order, of the measurement.");
    method.bind(options, tune_formula);
    return method;
}

}  // namespace tunewright
