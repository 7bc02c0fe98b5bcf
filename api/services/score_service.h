// POST /v1/score, and the request of the command of this name.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "api/outcome.h"
#include "engine/progress.h"

namespace tunewright::api {

Answer score_call(std::string_view body, const RunControl& control);

/// Options of the command, as typed; "" for one that is left out.
struct ScoreWords {
    std::string Kp, Ti, Td, method, structure, Ms, problems, name;
};

/// The request: that of the file, if it is JSON; a file of settings, CSV with the columns problem, Kp, Ti and Td; else
/// the formulas or the method of the words.
std::string score_request(const ScoreWords& words, const std::optional<std::string>& file);

}  // namespace tunewright::api
