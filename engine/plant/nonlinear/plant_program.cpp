#include "engine/plant/nonlinear/plant_program.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/number_text.h"
#include "engine/plant/expression/parser.h"
#include "engine/plant/expression/program_builder.h"
#include "engine/plant/expression/program_run.h"
#include "engine/plant/expression/tokens.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"

namespace tunewright {
namespace {

/// The values of the parameters; those given as expressions are computed from the others.
struct ParameterValues {
    std::map<std::string, double> values;  // all finite
    int nodes = 0;                         // numbers, names and operations of the parameters' expressions
};

class Resolution {
public:
    explicit Resolution(const std::vector<Parameter>& parameters) : parameters_(parameters) {}

    Expected<ParameterValues> resolve() {
        ExpressionLimits limits;
        for (const auto& parameter : parameters_) {
            if (const auto* text = std::get_if<std::string>(&parameter.value)) {
                auto tree = parse_expression(*text, limits);
                if (!tree) return failed(parameter.name, tree.error().message);
                limits.used += static_cast<int>(tree->nodes.size());
                trees_.emplace(parameter.name, std::move(*tree));
            } else {
                const double value = std::get<double>(parameter.value);
                if (!std::isfinite(value))
                    return Error{ErrorKind::invalid_argument, "plant/parameters/" + parameter.name,
                                 "The parameter " + parameter.name + " must be a finite number or an expression."};
                result_.values.emplace(parameter.name, value);
            }
        }
        for (const auto& [name, tree] : trees_)
            if (auto error = work_out(name)) return *error;
        result_.nodes = limits.used;
        return std::move(result_);
    }

private:
    static Error failed(const std::string& name, const std::string& message) {
        return {ErrorKind::invalid_argument, "plant/parameters/" + name, "parameter " + name + ", " + message};
    }

    // Depth first; the depth is at most the number of parameters.
    std::optional<Error> work_out(const std::string& name) {
        if (result_.values.count(name)) return std::nullopt;
        if (const auto begin = std::find(path_.begin(), path_.end(), name); begin != path_.end()) {
            std::string circle;
            for (auto at = begin; at != path_.end(); ++at) circle += *at + " -> ";
            return Error{ErrorKind::invalid_argument, "plant/parameters/" + name,
                         "The definitions of the parameters are circular: " + circle + name + "."};
        }
        path_.push_back(name);
        const SyntaxTree& tree = trees_.at(name);
        for (const auto& other : tree.names)
            if (trees_.count(other))
                if (auto error = work_out(other)) return error;
        path_.pop_back();
        return evaluate(name, tree);
    }

    std::optional<Error> evaluate(const std::string& name, const SyntaxTree& tree) {
        ProgramBuilder builder({});
        auto error = builder.add_output(tree, "parameter " + name, [this](const std::string& other) -> NameMeaning {
            if (const auto found = result_.values.find(other); found != result_.values.end()) return found->second;
            return UnknownName{quoted(other) +
                               " is not a parameter; a parameter may use only numbers and other parameters."};
        });
        if (error) return failed(name, error->message);
        const Program program = builder.finish();
        double value = 0;
        program.evaluate<double>({}, std::span(&value, 1));
        if (!std::isfinite(value))
            return Error{ErrorKind::invalid_argument, "plant/parameters/" + name, program.fault<double>({}, 1) + "."};
        result_.values.emplace(name, value);
        return std::nullopt;
    }

    const std::vector<Parameter>& parameters_;
    std::map<std::string, SyntaxTree> trees_;
    std::vector<std::string> path_;
    ParameterValues result_;
};

constexpr std::size_t kMaxStates = 20, kMaxParameters = 200;

Error invalid(const std::string& where, const std::string& message) {
    return {ErrorKind::invalid_argument, "plant/" + where, message};
}

std::optional<Error> check_name(const std::string& name, const std::string& room, std::set<std::string>& taken) {
    if (!is_identifier(name))
        return invalid(room, quoted(name) +
                                 " cannot be a name. A name has letters, digits and underscores, and does not begin "
                                 "with a digit.");
    const std::string where = room == "input" ? room : room + "/" + name;
    if (is_function_name(name)) return invalid(where, quoted(name) + " is a function and cannot be a name.");
    if (!taken.insert(name).second)
        return invalid(where, quoted(name) + " is used twice: states, parameters and the input need different names.");
    return std::nullopt;
}

std::optional<Error> check_input(const ManipulatedInput& input) {
    if (!std::isfinite(input.nominal)) return invalid("input/nominal", "The nominal input must be a finite number.");
    if (input.min && !std::isfinite(*input.min)) return invalid("input/min", "min must be a finite number.");
    if (input.max && !std::isfinite(*input.max)) return invalid("input/max", "max must be a finite number.");
    if (input.min && input.max && *input.min >= *input.max)
        return invalid("input/min", "min = " + text(*input.min) + " must be below max = " + text(*input.max) + ".");
    if ((input.min && input.nominal < *input.min) || (input.max && input.nominal > *input.max))
        return invalid("input/nominal",
                       "The nominal input " + text(input.nominal) + " must lie within the limits min and max.");
    return std::nullopt;
}

std::optional<Error> check_numbers_and_names(const NonlinearPlant& plant) {
    if (plant.states.empty()) return invalid("states", "A nonlinear plant needs at least one state.");
    if (plant.states.size() > kMaxStates)
        return invalid("states", std::to_string(plant.states.size()) + " states; at most " +
                                     std::to_string(kMaxStates) + " are possible.");
    if (plant.parameters.size() > kMaxParameters)
        return invalid("parameters", std::to_string(plant.parameters.size()) + " parameters; at most " +
                                         std::to_string(kMaxParameters) + " are possible.");
    std::set<std::string> taken;
    for (const auto& state : plant.states) {
        if (auto error = check_name(state.name, "states", taken)) return error;
        if (!std::isfinite(state.value))
            return invalid("states/" + state.name, "The value of " + state.name + " must be a finite number.");
    }
    for (const auto& parameter : plant.parameters)
        if (auto error = check_name(parameter.name, "parameters", taken)) return error;
    if (auto error = check_name(plant.input.name, "input", taken)) return error;
    if (auto error = check_input(plant.input)) return error;
    if (!(plant.L >= 0) || !std::isfinite(plant.L))
        return invalid("L", "The dead time L must be a finite number >= 0.");
    return std::nullopt;
}

// The equation of each state, in the states' order.
Expected<std::vector<const NamedExpression*>> equations_in_order(const NonlinearPlant& plant) {
    std::map<std::string, const NamedExpression*> by_name;
    for (const auto& equation : plant.equations)
        if (!by_name.emplace(equation.name, &equation).second)
            return invalid("equations", "There are two equations for " + quoted(equation.name) + ".");
    std::vector<const NamedExpression*> result;
    for (const auto& state : plant.states) {
        const auto found = by_name.find(state.name);
        if (found == by_name.end())
            return invalid("equations", "The state " + state.name + " has no equation: give its derivative d" +
                                            state.name + "/dt as equations." + state.name + ".");
        result.push_back(found->second);
        by_name.erase(found);
    }
    if (!by_name.empty())
        return invalid("equations", "The equation of " + quoted(by_name.begin()->first) +
                                        " belongs to no state: add a state of that name with its operating value.");
    return result;
}

class Compilation {
public:
    Compilation(const NonlinearPlant& plant, const ParameterValues& parameters)
        : plant_(plant), parameters_(parameters.values), limits_{.used = parameters.nodes} {
        for (std::size_t i = 0; i < plant.states.size(); ++i) variables_.emplace(plant.states[i].name, i);
        variables_.emplace(plant.input.name, plant.states.size());
    }

    Expected<PlantProgram> compile(const std::vector<const NamedExpression*>& equations) {
        ProgramBuilder joint(names()), alone(names());
        for (const auto* equation : equations)
            if (auto error = add(joint, "equations/" + equation->name, "equation " + equation->name, equation->text))
                return *error;
        const auto limits = limits_;
        if (auto error = add(joint, "output", "output", plant_.output)) return *error;
        limits_ = limits;
        if (auto error = add(alone, "output", "output", plant_.output)) return *error;
        PlantProgram program{joint.finish(), alone.finish()};
        if (auto error = check_output(program.output)) return *error;
        return program;
    }

private:
    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const auto& state : plant_.states) result.push_back(state.name);
        result.push_back(plant_.input.name);
        return result;
    }

    NameMeaning meaning(const std::string& name) const {
        if (const auto variable = variables_.find(name); variable != variables_.end())
            return VariableIndex{static_cast<int>(variable->second)};
        if (const auto value = parameters_.find(name); value != parameters_.end()) return value->second;
        return UnknownName{quoted(name) + " is not a state, parameter or input of this plant."};
    }

    std::optional<Error> add(ProgramBuilder& builder, const std::string& where, const std::string& source,
                             const std::string& text) {
        auto tree = parse_expression(text, limits_);
        auto error = tree ? builder.add_output(*tree, source, [this](const auto& name) { return meaning(name); })
                          : std::optional<Error>(tree.error());
        if (error) return invalid(where, source + ", " + error->message);
        limits_.used += static_cast<int>(tree->nodes.size());
        return std::nullopt;
    }

    std::optional<Error> check_output(const Program& output) const {
        const auto used = output.variables_of(0);
        const std::size_t n = plant_.states.size();
        if (used[n])
            return invalid("output",
                           "The output contains the input " + plant_.input.name +
                               ", but y = h(x) must depend only on the states. Make the actuator or sensor a state.");
        for (std::size_t i = 0; i < n; ++i)
            if (used[i]) return std::nullopt;
        return invalid("output", "The output contains no state, so it would never change.");
    }

    const NonlinearPlant& plant_;
    const std::map<std::string, double>& parameters_;
    ExpressionLimits limits_;
    std::map<std::string, std::size_t> variables_;
};

}  // namespace

Expected<PlantProgram> compile_plant(const NonlinearPlant& plant) {
    if (auto error = check_numbers_and_names(plant)) return *error;
    const auto equations = equations_in_order(plant);
    if (!equations) return equations.error();
    const auto parameters = Resolution(plant.parameters).resolve();
    if (!parameters) return parameters.error();
    return Compilation(plant, *parameters).compile(*equations);
}

}  // namespace tunewright
