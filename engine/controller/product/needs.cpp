#include "engine/controller/product/needs.h"

namespace tunewright::product {
namespace {

Error missing_span(const Product& product, const Parameter& parameter, const char* what, const char* whose,
                   const char* example) {
    return {ErrorKind::invalid_argument, what,
            std::string(what) + " is missing; " + std::string(parameter.name) + " of " + std::string(product.name) +
                " is " + formula_text(product, parameter) + ". Give the range of " + whose + ", such as \"" + what +
                "\": " + example + "."};
}

Error missing_sample_time(const Product& product, const std::string& why) {
    return {ErrorKind::invalid_argument, "sample_time",
            "sample_time is missing; " + why + ", and " + std::string(product.name) +
                " has no default. Give the period at which the block is called."};
}

}  // namespace

Clocks clocks_of(const Product& product, const Context& context) {
    Clocks clocks;
    const Algorithm& algorithm = product.algorithm;
    if (algorithm.firmware_clock) {
        clocks.firmware = context.loop_clock_s.value_or(algorithm.sample_time_s.value_or(0));
        clocks.sample_time = clocks.firmware;
        return clocks;
    }
    clocks.sample_time = context.loop_clock_s ? context.loop_clock_s : context.sample_time_s;
    if (!clocks.sample_time) clocks.sample_time = algorithm.sample_time_s;
    return clocks;
}

Quantities quantities_of(const Product& product, const Context& context) {
    Quantities quantities;
    if (context.y_span_given) quantities.Sy = context.spans.y_high - context.spans.y_low;
    if (context.u_span_given) quantities.Su = context.spans.u_high - context.spans.u_low;
    quantities.Ts = clocks_of(product, context).sample_time.value_or(1);
    return quantities;
}

std::optional<Error> missing_for(const Product& product, const Parameter& parameter, const Context& context) {
    const bool power = parameter.shape == Shape::power;
    if (power && parameter.term.Sy != 0 && !context.y_span_given)
        return missing_span(product, parameter, "y_span", "the measurement", "[0, 200]");
    if (power && parameter.term.Su != 0 && !context.u_span_given)
        return missing_span(product, parameter, "u_span", "the output", "[0, 100]");
    const bool timed = (power && parameter.term.Ts != 0) || parameter.shape == Shape::slope_samples;
    if (timed && !clocks_of(product, context).sample_time)
        return missing_sample_time(product, std::string(parameter.name) + " is " + formula_text(product, parameter));
    return std::nullopt;
}

std::optional<Error> missing_for_filter(const Product& product, const Context& context) {
    const FilterKind kind = product.filter.kind;
    if (kind != FilterKind::slope && kind != FilterKind::four_points) return std::nullopt;
    if (clocks_of(product, context).sample_time) return std::nullopt;
    return missing_sample_time(product, "the delay of its derivative is counted in periods");
}

std::vector<std::string> needs_of(const Product& product) {
    std::vector<std::string> needs;
    Context context;
    // Adds one missing value at a time until nothing is missing.
    for (int k = 0; k < 3; ++k) {
        std::optional<Error> missing = missing_for_filter(product, context);
        for (const Parameter& parameter : product.parameters) {
            if (!missing && parameter.role != ParameterRole::limit) missing = missing_for(product, parameter, context);
        }
        if (!missing) break;
        needs.push_back(missing->where);
        if (missing->where == "y_span") context.y_span_given = true;
        if (missing->where == "u_span") context.u_span_given = true;
        if (missing->where == "sample_time") context.sample_time_s = 1;
    }
    return needs;
}

bool uses_firmware_clock(const Product& product) {
    if (!product.algorithm.firmware_clock) return false;
    return product.filter.kind == FilterKind::parameter || product.filter.kind == FilterKind::slope;
}

}  // namespace tunewright::product
