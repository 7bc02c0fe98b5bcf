// A plant described by differential equations in text: x' = f(x, u(t - L)), y = h(x). All values are absolute, in the
// user's units; everything linear works on the linearisation about the steady state (nonlinear_system.h).
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

/// A number, or an expression in numbers and other parameters (in any order, without circles).
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
    std::vector<NamedExpression> equations;  ///< d/dt of each state, in states, parameters and the input
    ManipulatedInput input;
    std::string output;  ///< in states and parameters
    double L = 0;        ///< dead time of the input, >= 0
};

}  // namespace tunewright
