// Malformed and hostile descriptions of a nonlinear plant: each gets an error that names the place and the cure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "engine/plant/nonlinear/lie_derivatives.h"
#include "tests/engine/plant/nonlinear_plants.h"

namespace tunewright {
namespace {

struct Refusal {
    std::function<void(NonlinearPlant&)> change;  // of the CSTR with output T
    std::string where, message;                   // the beginning of the message
};

void set_equation(NonlinearPlant& plant, const std::string& state, const std::string& text) {
    for (auto& equation : plant.equations)
        if (equation.name == state) equation.text = text;
}

void expect_refusals(const std::vector<Refusal>& refusals) {
    for (const auto& [change, where, message] : refusals) {
        NonlinearPlant plant = cstr("T");
        change(plant);
        const auto system = NonlinearSystem::make(plant);
        ASSERT_FALSE(system.has_value()) << message;
        EXPECT_EQ(system.error().where, where);
        EXPECT_THAT(system.error().message, testing::StartsWith(message));
        EXPECT_EQ(system.error().kind, ErrorKind::invalid_argument);
    }
}

std::string repeated(const std::string& piece, int times) {
    std::string result;
    for (int i = 0; i < times; ++i) result += piece;
    return result;
}

TEST(NonlinearRefusals, Texts) {
    const auto T = [](const std::string& text) {
        return [text](NonlinearPlant& plant) { set_equation(plant, "T", text); };
    };
    expect_refusals({
        {T("F/V*(TA0-T"), "plant/equations/T", "equation T, character 5: this parenthesis is not closed."},
        {T(""), "plant/equations/T", "equation T, the expression is empty."},
        {T("F/V*(TA0-Temp)+Tj"), "plant/equations/T",
         "equation T, character 10: \"Temp\" is not a state, parameter or input of this plant."},
        {T("import(os)"), "plant/equations/T", "equation T, character 1: \"import\" is not a function;"},
        {T("T'; DROP TABLE jobs"), "plant/equations/T",
         "equation T, character 2: \"'\" cannot be part of an expression."},
        {T(repeated("(", 100000) + "T" + repeated(")", 100000)), "plant/equations/T",
         "equation T, the expression is 200001 characters long; at most 10000 are read."},
        {T(repeated("(", 4000) + "T" + repeated(")", 4000)), "plant/equations/T",
         "equation T, character 101: the expression is nested more than 100 levels deep."},
        {T("Tj-T" + repeated("+T", 2600)), "plant/equations/T",
         "equation T, character 4986: the expressions have more than 5000 numbers, names and operations."},
        {[](NonlinearPlant& plant) { plant.output = "T +"; }, "plant/output",
         "output, character 4: the expression ends where"},
        {[](NonlinearPlant& plant) { plant.output = "T + 0.1*Tj"; }, "plant/output",
         "The output contains the input Tj, but y = h(x) must depend only on the states."},
        {[](NonlinearPlant& plant) { plant.output = "V"; }, "plant/output", "The output contains no state"},
        {[](NonlinearPlant& plant) { plant.output = "log(CA - 1)"; }, "plant/output",
         "The output cannot be evaluated at the steady state: output, character 1: log of -0.4797 does not exist."},
    });
}

TEST(NonlinearRefusals, NamesAndNumbers) {
    constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
    using Plant = NonlinearPlant;
    expect_refusals({
        {[](Plant& p) { p.states.clear(); }, "plant/states", "A nonlinear plant needs at least one state."},
        {[](Plant& p) { p.equations.pop_back(); }, "plant/equations",
         "The state T has no equation: give its derivative dT/dt as equations.T."},
        {[](Plant& p) { p.states.pop_back(); }, "plant/equations", "The equation of \"T\" belongs to no state:"},
        {[](Plant& p) {
             p.equations.push_back({"T", "0"});
         },
         "plant/equations", "There are two equations for \"T\"."},
        {[](Plant& p) {
             p.parameters.push_back({"T", 1.0});
         },
         "plant/parameters/T", "\"T\" is used twice:"},
        {[](Plant& p) { p.input.name = "CA"; }, "plant/input", "\"CA\" is used twice:"},
        {[](Plant& p) {
             p.parameters.push_back({"exp", 1.0});
         },
         "plant/parameters/exp", "\"exp\" is a function and cannot be a name."},
        {[](Plant& p) { p.states[0].name = "C A"; }, "plant/states", "\"C A\" cannot be a name."},
        {[](Plant& p) { p.states[0].value = kNotANumber; }, "plant/states/CA",
         "The value of CA must be a finite number."},
        {[](Plant& p) { p.input.nominal = kNotANumber; }, "plant/input/nominal",
         "The nominal input must be a finite number."},
        {[](Plant& p) { p.input.min = 500; }, "plant/input/nominal",
         "The nominal input 493.9 must lie within the limits"},
        {[](Plant& p) { p.input.min = p.input.max = 493.87; }, "plant/input/min", "min = 493.9 must be below max"},
        {[](Plant& p) { p.L = -1; }, "plant/L", "The dead time L must be a finite number >= 0."},
        {[](Plant& p) {
             p.states.resize(21, {"x", 0});
         },
         "plant/states", "21 states; at most 20 are possible."},
        {[](Plant& p) {
             p.parameters.resize(201, {"p", 0.0});
         },
         "plant/parameters", "201 parameters; at most 200"},
    });
}

TEST(NonlinearRefusals, Parameters) {
    const auto k0 = [](const std::string& text) {
        return [text](NonlinearPlant& plant) { plant.parameters[6].value = text; };
    };
    expect_refusals({
        {k0("k0 + 1"), "plant/parameters/k0", "The definitions of the parameters are circular: k0 -> k0."},
        {[](NonlinearPlant& p) {
             p.parameters.push_back({"a", "b*2"});
             p.parameters.push_back({"b", "V + c"});
             p.parameters.push_back({"c", "a/3"});
         },
         "plant/parameters/a", "The definitions of the parameters are circular: a -> b -> c -> a."},
        {k0("4.71e8*T"), "plant/parameters/k0",
         "parameter k0, character 8: \"T\" is not a parameter; a parameter may use only numbers and other parameters."},
        {k0("V/(F-100)"), "plant/parameters/k0", "parameter k0, character 2: division by zero."},
        {k0("exp(1000)"), "plant/parameters/k0", "parameter k0, character 1: exp of 1000 is not finite."},
        {k0("2^(2^(2^(2^(2^2))))"), "plant/parameters/k0", "parameter k0, character 5: 2 ^ 6.554e+04 is not finite."},
        {k0("1e400"), "plant/parameters/k0", "parameter k0, character 1: \"1e400\" is out of the range"},
        {k0("4.71e8)"), "plant/parameters/k0", "parameter k0, character 7: \")\" stands where"},
    });
}

TEST(NonlinearRefusals, OperatingPoints) {
    const auto T = [](const std::string& text) {
        return [text](NonlinearPlant& plant) { set_equation(plant, "T", text); };
    };
    expect_refusals({
        {T("Tj - T + 1/(CA - 0.52)"), "plant/states",
         "The equations cannot be evaluated at the operating point (CA = 0.52, T = 398.97, Tj = 493.87): equation T, "
         "character 11: division by zero."},
        {T("log(T - 500) + Tj"), "plant/states",
         "The equations cannot be evaluated at the operating point (CA = 0.52, T = 398.97, Tj = 493.87): equation T, "
         "character 1: log of -101 does not exist."},
        {T("exp(T^2) + Tj"), "plant/states", "The equations cannot be evaluated at the operating point"},
        {T("1 + T^2 + Tj^2"), "plant/states", "There is no steady state near these states for Tj = 493.87:"},
        {[](NonlinearPlant& p) { p.input.nominal = 5000; }, "plant/states",
         "There is no steady state near these states for Tj = 5000:"},
        {[](NonlinearPlant& p) { set_equation(p, "CA", "sqrt(CA - 0.52) + 0*Tj"); }, "plant/states",
         "The equations cannot be evaluated at the operating point (CA = 0.52, T = 398.97, Tj = 493.87): equation CA, "
         "character 1: sqrt of 0 has no finite derivative."},
    });
}

TEST(NonlinearRefusals, RelativeDegrees) {
    const auto refused = [](const NonlinearPlant& plant) {
        const auto r = relative_degree(made_system(plant));
        EXPECT_FALSE(r.has_value());
        return r ? Error{} : r.error();
    };
    NonlinearPlant plant = cstr("T");
    set_equation(plant, "T", plant.equations[1].text + "+ 0.001*(Tj - 493.87)^2");
    EXPECT_EQ(refused(plant).where, "plant/equations/T");
    EXPECT_THAT(refused(plant).message,
                testing::StartsWith("equation T, character 83: the input Tj enters nonlinearly;"));

    plant = cstr("T");
    plant.states.push_back({"w", 1});
    plant.equations.push_back({"w", "1 - w"});
    plant.output = "w";
    EXPECT_THAT(
        refused(plant).message,
        testing::StartsWith("The input Tj enters no derivative of the output up to the order 3 of the plant, so"));

    // u moves x through sin(x), which is 0 at x = 0 but not near it.
    EXPECT_THAT(refused(scalar_plant("-x + sin(x)*u", 0)).message,
                testing::StartsWith("The relative degree is undefined at the operating point:"));
}

}  // namespace
}  // namespace tunewright
