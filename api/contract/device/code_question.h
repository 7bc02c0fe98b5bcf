// The rules of a controller's program: for its source text, and for a simulation of it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "api/describe/description.h"
#include "engine/code/algorithm.h"
#include "engine/code/print.h"

namespace tunewright::api {

/// Times are in the result's own unit (units.time), u and y in the result's units.
struct CodeQuestion {
    code::Language language = code::Language::structured_text;
    std::optional<double> sample_time;
    IntegralRule integral = IntegralRule::backward;
    DerivativeRule derivative = DerivativeRule::filtered_backward;
    std::optional<int> slope_samples;  ///< of the rule `slope`, which needs it
    bool velocity = false;
    std::optional<code::AntiWindup> anti_windup;
    std::optional<double> tracking_time, u_min, u_max, rate_limit, bias, y0;
    /// For a cascade: the range of r2, and r2 at the operating point. For a feedforward: the disturbance at the
    /// operating point, and the kind of compensator.
    std::optional<double> r2_min, r2_max, r2_bias, d0;
    std::optional<std::string> compensator;
};

Codec<code::Language> code_language();
/// Read from an object of the parameters as typed, with numbers as numbers.
const Description<CodeQuestion>& code_contract();

/// Reports at the reader's place the members that belong to another structure; `structure` "": to any.
void refuse_others(const CodeQuestion& question, std::string_view structure, Reader& reader);
/// The program that a simulation executes: the same without a language, and steps by their names.
struct SampledWish : CodeQuestion {
    std::map<std::string, double> steps;  ///< sizes of steps; 1 for the others
};
const Description<SampledWish>& sampled_wish_contract();

}  // namespace tunewright::api
