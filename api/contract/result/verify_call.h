// The contract of POST /v1/verify: a request with its result in, every figure that a second way gives out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/describe/description.h"

namespace tunewright::api {

/// A request with its result; both are read as their own contracts have them.
struct VerifyRequest {
    Json request, result;
};

/// A number, true or false, or null.
struct VerifiedFigure {
    std::string where;   ///< JSON Pointer into the result
    std::string figure;  ///< its kind, which decides what is allowed
    Json given, found;
    std::optional<double> difference;  ///< relative; empty if one of both is no number
    double allowed = 0;
    bool agrees = false;
};

struct UnverifiedPart {
    std::string where;
    std::string why;
};

struct VerifyAnswer {
    std::vector<VerifiedFigure> figures;
    std::vector<UnverifiedPart> not_verified;

    int differing() const;
};

const Description<VerifyRequest>& verify_request_contract();
const Description<VerifyAnswer>& verify_answer_contract();

}  // namespace tunewright::api
