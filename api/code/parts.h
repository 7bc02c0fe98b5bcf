// The two ends of a controller's code: what may be asked of it (the parameters of the call, which are the options of
// the command), and what it says of where it comes from.
#pragma once

#include <optional>

#include "api/describe/description.h"
#include "engine/code/algorithm.h"
#include "engine/code/print.h"

namespace tunewright::api {

/// Times are in the result's own unit (units.time), u and y in theirs.
struct CodeQuestion {
    code::Language language = code::Language::structured_text;
    std::optional<double> sample_time;
    IntegralRule integral = IntegralRule::backward;
    DerivativeRule derivative = DerivativeRule::filtered_backward;
    std::optional<int> slope_samples;  ///< of the rule slope, which needs it
    bool velocity = false;
    std::optional<code::AntiWindup> anti_windup;
    std::optional<double> tracking_time, u_min, u_max, rate_limit, bias, y0;
};

/// Read from an object of the parameters as they were typed, numbers as numbers.
const Description<CodeQuestion>& code_contract();

/// Lines of the head comment from a result, one of its entries, and the request (null where it is not known).
code::Provenance provenance_of(const Json& result, const Json& entry, const Json& request);

}  // namespace tunewright::api
