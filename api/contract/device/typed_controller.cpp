#include "api/contract/device/typed_controller.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "engine/controller/product/catalogue.h"
#include "engine/plant/expression/tokens.h"
#include "engine/plant/typed/call.h"
#include "engine/plant/typed/program.h"

namespace tunewright::api {
namespace {

using product::Constructor;
using product::Parameter;
using product::Product;
using namespace typed;

constexpr const char* kTransferFunction = "python_control";

/// A constructor with its product.
struct ReadableProduct {
    const Constructor* constructor;
    const Product* product;
};

std::vector<ReadableProduct> readable_products(std::string_view function) {
    std::vector<ReadableProduct> found;
    for (const Constructor& constructor : product::constructors())
        if (constructor.function == function) found.push_back({&constructor, product::find(constructor.product)});
    return found;
}

const Parameter* parameter_of(const Product& product, std::string_view argument) {
    const auto found = std::ranges::find_if(product.parameters,
                                            [&](const Parameter& one) { return lower(one.name) == lower(argument); });
    return found == product.parameters.end() ? nullptr : &*found;
}

bool is_outside(const Constructor& constructor, std::string_view argument) {
    return std::ranges::any_of(constructor.outside,
                               [&](std::string_view name) { return lower(name) == lower(argument); });
}

/// True if the product's constructor has all arguments of the call.
bool fits(const ReadableProduct& candidate, const Call& call) {
    const Constructor& constructor = *candidate.constructor;
    if (call.inputs.size() > constructor.inputs.size() || call.inputs.size() < constructor.required) return false;
    return std::ranges::all_of(call.named, [&](const auto& named) {
        return parameter_of(*candidate.product, named.first) || is_outside(constructor, named.first);
    });
}

/// The word as one of the parameter's values: symbols of Julia begin with a colon there.
product::Value word_for(const Parameter& parameter, const std::string& word) {
    const auto known = [&](const std::string& spelling) {
        const product::Value value = spelling;
        return (parameter.standard && *parameter.standard == value) ||
               std::ranges::any_of(parameter.options, [&](const auto& option) { return option.value == value; });
    };
    return known(":" + word) ? ":" + word : word;
}

void add_setting(const Parameter& parameter, const Argument& argument, Cursor& cursor, product::Settings& settings) {
    const bool has_words = !parameter.options.empty() || parameter.shape == product::Shape::constant;
    if (argument.is_word && has_words) {
        settings.push_back({std::string(parameter.name), word_for(parameter, argument.word)});
        return;
    }
    const double value = number_of(argument, cursor);
    if (std::isfinite(value)) {
        settings.push_back({std::string(parameter.name), value});
    } else if (parameter.standard) {
        cursor.fail(argument.position,
                    std::string(parameter.name) + " is infinite here; write a large number instead.");
    }
}

Expected<TypedController> of_call(const ReadableProduct& candidate, const Call& call, Cursor& cursor) {
    const auto& [constructor, product] = candidate;
    TypedController typed{std::string(product->id), {}};
    for (std::size_t i = 0; i < call.inputs.size(); ++i)
        add_setting(*parameter_of(*product, constructor->inputs[i]), call.inputs[i], cursor, typed.settings);
    for (const auto& [name, argument] : call.named) {
        if (is_outside(*constructor, name)) continue;
        const Parameter& parameter = *parameter_of(*product, name);
        const bool twice = std::ranges::any_of(
            typed.settings, [&](const product::Setting& setting) { return setting.name == parameter.name; });
        if (twice) cursor.fail(argument.position, tunewright::quoted(argument.name) + " is given twice.");
        add_setting(parameter, argument, cursor, typed.settings);
    }
    if (!cursor.failed() && !cursor.at_end()) cursor.unexpected("the end of the text");
    if (cursor.failed()) return cursor.fault();
    return typed;
}

std::string signature(const Constructor& constructor) {
    std::string out = std::string(constructor.function) + "(";
    for (std::size_t i = 0; i < constructor.inputs.size(); ++i)
        out += (i > 0 ? ", " : "") + std::string(constructor.inputs[i]);
    return out + ")";
}

/// The error of a call that fits no constructor, in the words of the first.
Error no_such_call(const ReadableProduct& candidate, const Call& call) {
    const auto& [constructor, product] = candidate;
    const std::size_t known = constructor->inputs.size();
    if (call.inputs.size() > known)
        return fault_at(call.inputs[known].position,
                        known == 0 ? "name the arguments of " + call.name + ", as in k=2."
                                   : "another argument would be a sample time; give the settings in continuous time, "
                                     "and the sample time in implement.");
    for (const auto& [name, argument] : call.named)
        if (!parameter_of(*product, name) && !is_outside(*constructor, name))
            return fault_at(argument.position, tunewright::quoted(argument.name) + " is not a setting of " +
                                                   std::string(product->name) + "; leave it out.");
    return fault_at(call.position, "arguments are missing; write " + signature(*constructor) + ".");
}

Error two_meanings(const std::vector<ReadableProduct>& candidates, const Call& call) {
    std::string all;
    for (const auto& [constructor, product] : candidates)
        all += (all.empty() ? "" : ", or of ") + std::string(product->name) + ", " + std::string(product->law);
    return fault_at(call.position, "this call may be of " + all +
                                       ". Write pid(Kp, Ki, Kd, Tf) for the first, or pid(Kp, Ti, Td; form=:standard) "
                                       "for the second.");
}

/// The coefficients of s^2, s and 1; empty for a higher degree.
std::optional<std::vector<double>> three_coefficients(std::vector<double> polynomial) {
    if (polynomial.size() > 3) return std::nullopt;
    polynomial.insert(polynomial.begin(), 3 - polynomial.size(), 0);
    return polynomial;
}

// num/den = Kp + Ki/s + Kd s/(Tf s + 1): den = s (Tf s + 1) or one of its factors.
Expected<TypedController> of_formula(const Formula& formula) {
    const auto refused = [](const std::string& what) { return Error{ErrorKind::invalid_argument, "", what}; };
    if (formula.L != 0) return refused("the formula has a dead time, which a PID controller has not. Leave it out.");
    Polynomial num = expanded(formula.num), den = expanded(formula.den);
    for (double& c : num) c *= formula.gain;
    while (num.size() > 1 && den.size() > 1 && num.back() == 0 && den.back() == 0) num.pop_back(), den.pop_back();
    const bool integral = den.back() == 0;
    if (!integral) num.push_back(0), den.push_back(0);
    const auto n = three_coefficients(std::move(num)), d = three_coefficients(std::move(den));
    constexpr const char* kForm = "Kp + Ki/s + Kd s/(Tf s + 1)";
    if (!n || !d || (*d)[1] == 0 || (*d)[2] != 0)
        return refused(std::string("the formula is not a PID controller, ") + kForm +
                       "; write it in this form, or give its settings.");
    const double scale = (*d)[1], Tf = (*d)[0] / scale, Ki = (*n)[2] / scale;
    const double Kp = (*n)[1] / scale - Ki * Tf, Kd = (*n)[0] / scale - Kp * Tf;
    if (!std::isfinite(Kp) || !std::isfinite(Ki) || !std::isfinite(Kd) || !std::isfinite(Tf))
        return refused("the numbers are too large to be computed with.");
    if (Tf < 0) return refused("the filter of the formula has a negative time; it must be above 0.");
    return TypedController{kTransferFunction, {{"Kp", Kp}, {"Ki", Ki}, {"Kd", Kd}, {"Tf", Tf}}};
}

}  // namespace

Expected<TypedController> read_controller(std::string_view text) {
    auto words = words_of(text);
    if (!words) return words.error();
    std::vector<Statement> statements = statements_of(*words);
    constexpr const char* kExample = "write a controller such as pidstd(1.5, 120, 20, 10), or 1.5 + 0.0125/s.";
    if (statements.empty())
        return Error{ErrorKind::invalid_argument, "", std::string("the text is empty; ") + kExample};
    const Statement last = value_of(statements.back());
    const auto candidates = at_call(Cursor(last)) ? readable_products(last[0].text) : std::vector<ReadableProduct>();
    if (candidates.empty()) {
        auto value = read_program(statements, 1);
        if (!value) return value.error();
        if (const auto* formula = std::get_if<Formula>(&*value)) return of_formula(*formula);
        return Error{ErrorKind::invalid_argument, "", std::string("a controller is not a state space; ") + kExample};
    }
    statements.pop_back();
    const auto names = read_names(statements, 1);
    if (!names) return names.error();
    Cursor cursor(last);
    const Call call = read_call(cursor, *names);
    if (cursor.failed()) return cursor.fault();
    std::vector<ReadableProduct> fitting;
    std::ranges::copy_if(candidates, std::back_inserter(fitting),
                         [&](const ReadableProduct& candidate) { return fits(candidate, call); });
    if (fitting.empty()) return no_such_call(candidates.front(), call);
    return fitting.size() > 1 ? two_meanings(fitting, call) : of_call(fitting.front(), call, cursor);
}

}  // namespace tunewright::api
