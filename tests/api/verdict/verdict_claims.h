// The claims of a verdict, checked against the figures of the same answer by independent rules: only the client's JSON
// is used, nothing of the engine's verdicts. A claim is a level, a number in a text, a figure, or words for a number
// ("about a quarter of", "within its limit", "stable on every plant").
#pragma once

#include <string>
#include <vector>

#include "api/json/json.h"

namespace tunewright::api {

/// One sentence for each claim of the answer's verdicts that a figure of the answer contradicts, for each number of a
/// text that is not among its figures, and for each entry whose level does not agree with its figures.
std::vector<std::string> contradictions(const Json& answer, const Json& request);

/// The finding with this code; null if there is none.
const Json* finding(const Json& verdict, const std::string& code);

/// The basis of all other rules: facts of the answer that forbid using the entry (unstable, not settling, Ms above 2),
/// or calling it good.
struct Facts {
    bool bad = false;
    bool not_good = false;
    std::string why;  ///< the reason, for the failure's message
};
Facts facts_of(const Json& entry, const Json& request);

}  // namespace tunewright::api
