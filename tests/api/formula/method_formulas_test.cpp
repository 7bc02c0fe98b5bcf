// The formulas of all methods as MathML, checked against their source text and against the methods' results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "api/formula/method_mathml.h"
#include "api/formula/notation.h"
#include "engine/plant/expression/parser.h"
#include "engine/plant/expression/scalar.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"
#include "tests/api/formula/read_mathml.h"
#include "tests/engine/tuning/rule_support.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;
using Values = std::map<std::string, double>;

Markup table_of(const std::string& formula) {
    const auto mathml = method_mathml(formula);
    EXPECT_TRUE(mathml) << formula << "\n" << mathml.error().message;
    return mathml ? read_markup(*mathml).inside.at(0).inside.at(0) : Markup{};
}

/// The value of a text in which every operator is written; empty if it is not valid in the engine's expression
/// language.
std::optional<double> value_of(const std::string& text, const Values& values) {
    const auto tree = parse_expression(text);
    if (!tree) return std::nullopt;
    std::vector<double> results;
    for (const SyntaxNode& node : tree->nodes) {
        const auto operand = [&](int i) { return node.operands[i] < 0 ? 0 : results[std::size_t(node.operands[i])]; };
        if (node.operation == Operation::number)
            results.push_back(node.number);
        else if (node.operation == Operation::variable)
            results.push_back(values.at(tree->names[std::size_t(node.name)]));
        else
            results.push_back(apply(node.operation, operand(0), operand(1), operand(2)));
    }
    return results.back();
}

/// Only letters, digits and signs, without the parts that have a two-dimensional layout: brackets, slashes, powers,
/// indices.
std::string names_and_signs(const std::string& text) {
    std::string out;
    for (const char c : on_a_keyboard(text))
        if (std::string(" ()[]/*^_.;").find(c) == std::string::npos) out += c;
    return out;
}

TEST(MethodFormulas, EachKeepsEveryNameNumberAndSignInItsOrder) {
    for (const TuningMethod& method : method_registry())
        EXPECT_EQ(names_and_signs(leaves(table_of(method.formula))), names_and_signs(method.formula)) << method.id;
}

// ---- each equation has the same value in both notations

/// Writes products with *, and indices with _, by looking at adjacent tokens only.
std::string with_operators(const std::string& text) {
    std::string out, name;
    char before = 0;  // n: a number, a name or a closing bracket; f: a function; o: anything else
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_' ||
                                     (text[end] == '.' && std::isdigit(static_cast<unsigned char>(text[i])))))
            ++end;
        std::string piece = text.substr(i, std::max<std::size_t>(end - i, 1));
        i += piece.size();
        if (piece == " ") continue;
        if (piece == "[") piece = "(";
        if (piece == "]") piece = ")";
        const bool value = end > i - piece.size() && std::isalnum(static_cast<unsigned char>(piece[0]));
        if (before == 'n' && (value || piece == "(")) out += "*";
        const bool function = piece == "min" || piece == "max" || piece == "exp";
        before = function ? 'f' : value || piece == ")" ? 'n' : 'o';
        out += piece;
    }
    return out;
}

/// Kp, K_p and a1, a_1 are one name: removes the underscore.
std::string one_spelling(std::string text) {
    std::erase(text, '_');
    return text;
}

/// The equations of a formula's text: the parts between separators outside brackets that have one =.
std::vector<std::string> equations_of_text(const std::string& formula) {
    std::vector<std::string> pieces{""};
    int depth = 0;
    for (std::size_t i = 0; i < formula.size(); ++i) {
        const char c = formula[i];
        depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
        const bool separates = c == ';' || c == ':' || (c == ',' && depth == 0) ||
                               (c == '.' && (i + 1 == formula.size() || formula[i + 1] == ' '));
        if (separates)
            pieces.emplace_back();
        else
            pieces.back() += c;
    }
    std::erase_if(pieces, [](const std::string& piece) { return std::ranges::count(piece, '=') != 1; });
    return pieces;
}

void collect_equations(const Markup& markup, std::vector<std::string>& found) {
    if (markup.tag == "mtd") {
        std::string text = typed_out(markup);
        if (text.ends_with(",")) text.pop_back();
        const bool limit = text.find("<=") != text.npos || text.find(">=") != text.npos;
        if (std::ranges::count(text, '=') == 1 && !limit) found.push_back(text);
    }
    for (const Markup& one : markup.inside) collect_equations(one, found);
}

std::string side(const std::string& equation, bool right) {
    const std::size_t equals = equation.find('=');
    return one_spelling(right ? equation.substr(equals + 1) : equation.substr(0, equals));
}

TEST(MethodFormulas, EachEquationHasTheValueOfItsText) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> between(0.5, 2);
    int compared = 0;
    for (const TuningMethod& method : method_registry()) {
        std::vector<std::string> shown;
        collect_equations(table_of(method.formula), shown);
        std::vector<std::pair<std::string, std::string>> text_sides;
        for (const std::string& equation : equations_of_text(method.formula)) {
            const std::string spelt = with_operators(equation);
            text_sides.emplace_back(side(spelt, false), side(spelt, true));
        }
        for (const std::string& equation : shown) {
            const auto tree = parse_expression(side(equation, true));
            if (!tree) continue;  // an integral, a sum, words
            Values values;
            for (const std::string& name : tree->names) values[name] = between(random);
            const auto same = std::ranges::find_if(text_sides, [&](const auto& sides) {
                const auto other = parse_expression(sides.second);
                return names_and_signs(sides.first) == names_and_signs(side(equation, false)) && other &&
                       names_and_signs(sides.second) == names_and_signs(side(equation, true));
            });
            ASSERT_FALSE(same == text_sides.end()) << method.id << ": " << equation;
            EXPECT_NEAR(*value_of(same->second, values), *value_of(side(equation, true), values), 1e-12)
                << method.id << ": " << equation;
            ++compared;
        }
    }
    EXPECT_GT(compared, 90);
}

// ---- the displayed formula gives the method's result

/// The values defined by the equations of the unlabelled lines and of those with this label, one after another.
Values worked_out(const std::string& formula, const std::string& label, Values values) {
    for (const Markup& line : table_of(formula).inside) {
        const std::string named = on_a_keyboard(leaves(line.inside.at(0)));
        if (!named.empty() && named != label + ":") continue;
        for (std::size_t i = 1; i < line.inside.size(); ++i) {
            std::vector<std::string> equations;
            collect_equations(line.inside[i], equations);
            for (const std::string& equation : equations)
                values[side(equation, false)] = value_of(side(equation, true), values).value();
        }
    }
    return values;
}

struct Rule {
    const char *method, *label;
    test::Given options;
};

TEST(MethodFormulas, AreWhatTheMethodsCompute) {
    const Fopdt plant{.K = 2, .T = 10, .L = 3};
    const Values given{{"K", 2},      {"T", 10},   {"T1", 10},   {"L", 3},
                       {"lambda", 4}, {"tauc", 5}, {"Tlag", 10}, {"Tlead", 0}};
    for (const Rule& rule : std::initializer_list<Rule>{{"ziegler_nichols_step", "P", test::kP},
                                                        {"ziegler_nichols_step", "PI", test::kPI},
                                                        {"ziegler_nichols_step", "PID", test::kPID},
                                                        {"cohen_coon", "P", test::kP},
                                                        {"cohen_coon", "PI", test::kPI},
                                                        {"cohen_coon", "PID", test::kPID},
                                                        {"amigo", "PI", test::kPI},
                                                        {"amigo", "PID", test::kPID},
                                                        {"haalman", "PI", test::kPI},
                                                        {"lambda", "PI", {test::kPI[0], {"lambda", 4.0}}},
                                                        {"lambda", "PID", {test::kPID[0], {"lambda", 4.0}}},
                                                        {"improved_simc", "PI", {test::kPI[0], {"tau_c", 5.0}}},
                                                        {"tavakoli_ise", "", {}},
                                                        {"tavakoli_iae", "", {}},
                                                        {"tavakoli_itae", "", {}}}) {
        SCOPED_TRACE(std::string(rule.method) + " " + rule.label);
        const Values values = worked_out(find_method(rule.method)->formula, rule.label, given);
        const double Ti = values.contains("Ti") ? values.at("Ti") : INFINITY;
        const double Td = values.contains("Td") ? values.at("Td") : 0;
        test::expect_settings(test::tuned(rule.method, plant, rule.options), values.at("Kp"), Ti, Td);
    }
}

// ---- the notation

std::string cells(const std::string& text) {
    std::string out;
    for (const Markup& line : table_of(text).inside) {
        for (const Markup& cell : line.inside) out += "[" + typed_out(cell) + "]";
        out += "\n";
    }
    return out;
}

TEST(MethodFormulas, SlashesAndProductsBindFromLeftToRight) {
    EXPECT_EQ(cells("a b/c d"), "[][((a*b)/(c))*d]\n");
    EXPECT_EQ(cells("a/b/c"), "[][((((a)/(b)))/(c))]\n");
    EXPECT_EQ(cells("a (b + c)/(2 d)"), "[][((a*(b+c))/(2*d))]\n");
    EXPECT_EQ(cells("e^(-L/T)"), "[][(e)^(-L/T)]\n");
    EXPECT_EQ(cells("T1 (T1/L)^b1"), "[][T_1*((((T_1)/(L))))^(b_1)]\n");
}

TEST(MethodFormulas, LabelsLinesAndWordsAreTold) {
    EXPECT_EQ(cells("q = L/T; PID, Ms = 1.4: P: Kp = 1/q, Ti = min(T, 4 L), as it is"),
              "[][q=((L)/(T))]\n[PID, M_s=1.4 : P:][K_p=((1)/(q)),][T_i=min(T,4*L),][as it is]\n");
    EXPECT_EQ(cells("a step after a load step: 1, -2"), "[a step after a load step:][1,-2]\n");
}

TEST(MethodFormulas, WhatLeavesTheNotationIsSaidWithItsPlace) {
    const auto complaint = [](const char* text) {
        const auto read = method_mathml(text);
        return read ? "none" : read.error().message;
    };
    EXPECT_EQ(complaint("Kp = (T + L"), "character 12: the formula ends too early.");
    EXPECT_EQ(complaint("Kp = 2 T + / L"), "character 12: \"/\" stands where a number, a symbol or a bracket belongs.");
    EXPECT_EQ(complaint("Kp = T) L"), "character 7: \")\" is out of place here.");
    EXPECT_EQ(complaint("Kp = 2 # 3"), "character 8 has no meaning in a formula.");
    EXPECT_THAT(complaint("Kp = gain"), HasSubstr("ends too early"));
    EXPECT_THAT(complaint("max |S"), HasSubstr("ends too early"));
}

}  // namespace
}  // namespace tunewright::api
