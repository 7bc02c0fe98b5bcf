#include "engine/plant/nonlinear/parameter_values.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/plant/expression/parser.h"
#include "engine/plant/expression/program_builder.h"
#include "engine/plant/expression/tokens.h"

namespace tunewright {
namespace {

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
                         "The parameters are defined in a circle: " + circle + name + "."};
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
                               " is no parameter; parameters are made of numbers and other parameters."};
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

}  // namespace

Expected<ParameterValues> parameter_values(const std::vector<Parameter>& parameters) {
    return Resolution(parameters).resolve();
}

}  // namespace tunewright
