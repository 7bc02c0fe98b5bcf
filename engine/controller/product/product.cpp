#include "engine/controller/product/product.h"

#include <algorithm>

#include "engine/number_text.h"

namespace tunewright::product {
namespace {

constexpr int kDecimalDigits = 15;  // digits that a decimal keeps through arithmetic: 253, not 252.99999999999997

}  // namespace

bool depends_on_choice(const Product& product, const Parameter& parameter) {
    const auto decides = [&](const Option& option) {
        switch (parameter.role) {
            case ParameterRole::weight_b:
            case ParameterRole::weight_c: return option.free_weights;
            case ParameterRole::integral: return option.integral.has_value();
            case ParameterRole::derivative: return option.derivative.has_value();
            default: return false;
        }
    };
    return std::ranges::any_of(product.parameters,
                               [&](const Parameter& one) { return std::ranges::any_of(one.options, decides); });
}

const Parameter* parameter_named(const Product& product, std::string_view name) {
    const auto& all = product.parameters;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; });
    return found == all.end() ? nullptr : &*found;
}

const Parameter* parameter_of(const Product& product, ParameterRole role) {
    const auto& all = product.parameters;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.role == role; });
    return found == all.end() ? nullptr : &*found;
}

std::string_view to_string(Form form) {
    switch (form) {
        case Form::ideal: return "ideal";
        case Form::parallel: return "parallel";
        case Form::series: return "series";
        case Form::p_only: return "p_only";
    }
    return "ideal";
}

std::string_view to_string(ParameterRole role) {
    switch (role) {
        case ParameterRole::gain: return "gain";
        case ParameterRole::multiplier: return "multiplier";
        case ParameterRole::integral: return "integral";
        case ParameterRole::derivative: return "derivative";
        case ParameterRole::filter: return "filter";
        case ParameterRole::weight_b: return "weight_b";
        case ParameterRole::weight_c: return "weight_c";
        case ParameterRole::choice: return "choice";
        case ParameterRole::sample_time: return "sample_time";
        case ParameterRole::fixed: return "fixed";
        case ParameterRole::limit: return "limit";
    }
    return "fixed";
}

std::string_view to_string(EvidenceLevel level) {
    switch (level) {
        case EvidenceLevel::read: return "read";
        case EvidenceLevel::partly: return "partly";
        case EvidenceLevel::unverified: return "unverified";
    }
    return "unverified";
}

std::string text_of(const Value& value) {
    if (const double* number = std::get_if<double>(&value)) return tunewright::text(*number, kDecimalDigits);
    if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    return std::get<std::string>(value);
}

}  // namespace tunewright::product
