// What a verdict claims, checked against the figures of the same answer by rules of their own: nothing of the engine's
// verdicts is used, only the JSON that a client has. A claim is a level, a number of a text, a figure, or words that
// stand for a number ("about a quarter of", "within its limit", "stable on every plant").
#pragma once

#include <string>
#include <vector>

#include "api/json/json.h"

namespace tunewright::api {

/// One sentence for each claim of the answer's verdicts that a figure of the answer contradicts, for each number of a
/// text that is not among its figures, and for each entry whose level is not what its figures demand. `request`: what
/// was asked.
std::vector<std::string> contradictions(const Json& answer, const Json& request);

/// The finding of this code; null where there is none.
const Json* finding(const Json& verdict, const std::string& code);

/// What every other rule begins with: whether something in the answer speaks against using the entry (unstable, not at
/// rest, Ms above 2), or against calling it good.
struct Facts {
    bool bad = false;
    bool not_good = false;
    std::string why;  ///< what was found, for the failure's message
};
Facts facts_of(const Json& entry, const Json& request);

}  // namespace tunewright::api
