// The contract of POST /v1/score: a rule, or settings, against the library of problems with proved bounds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/describe/description.h"
#include "engine/request/plan.h"
#include "engine/score/score.h"

namespace tunewright::api {

struct SubmittedSettings {
    std::string problem;
    double Kp = 0, Ti = 0, Td = 0;
};

/// The problems that are asked for; what is left out admits all.
struct ProblemChoice {
    std::optional<std::string> name;  ///< the beginning of the names, such as "amigo/"
    std::optional<CertifiedStructure> structure;
    std::optional<double> Ms;

    bool admits(const score::Problem& problem) const;
};

struct ScoreRequest {
    std::optional<std::string> name;
    std::optional<MethodRequest> tune;
    std::vector<SubmittedSettings> settings;
    ProblemChoice problems;
};

struct ScoreAnswer {
    std::string name;  ///< of the request, or of the method
    score::Score score;
};

const Description<ScoreRequest>& score_request_contract();
const Description<ScoreAnswer>& score_answer_contract();

}  // namespace tunewright::api
