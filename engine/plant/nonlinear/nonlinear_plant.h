// A plant described by differential equations in text: x' = f(x, u(t - L)), y = h(x). All values are absolute, in the
// user's units; linear methods use the linearisation about the steady state (nonlinear_system.h).
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tunewright {

struct NamedValue {
    std::string name;
    double value = 0;
};

struct NamedExpression {
    std::string name, text;
};

/// A number, or an expression of numbers and other parameters (in any order, without circular definitions).
struct Parameter {
    std::string name;
    std::variant<double, std::string> value;
};

struct ManipulatedInput {
    std::string name = "u";
    double nominal = 0;                        ///< at the operating point
    std::optional<double> min = {}, max = {};  ///< absolute; min <= nominal <= max, min < max
};

struct NonlinearPlant {
    std::vector<NamedValue> states;  ///< values near the operating point
    std::vector<Parameter> parameters;
    std::vector<NamedExpression> equations;  ///< d/dt of each state as a function of states, parameters and the input
    ManipulatedInput input;
    std::string output;  ///< a function of states and parameters
    double L = 0;        ///< dead time of the input, >= 0
};

}  // namespace tunewright
