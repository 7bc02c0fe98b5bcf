// Parts of a result against the second computation: one controller, or an operating range.
#pragma once

#include <optional>
#include <string>

#include "api/contract/request.h"
#include "api/contract/result/verify_call.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright::api {

/// A linear plant of an answer; empty for any other value.
std::optional<LinearPlant> decode_plant(const Json& value);

/// The loop that the entries of a result share.
struct VerifiedSubject {
    const LinearPlant* plant = nullptr;  ///< null: there is no linear plant
    bool nonlinear = false;              ///< `plant` is the linearisation
    EvaluateOptions options;
};

/// Adds the figures of an entry at `where`, and its parts without a second way. Throws Json::exception for an entry
/// that only resembles one.
void verify_entry(VerifyAnswer& answer, const std::string& where, const Json& entry, const VerifiedSubject& subject);

/// Adds the figures of a result about an operating range: of its one setting, and of each point's own, at the points
/// that have a linear plant. Throws as above.
void verify_range(VerifyAnswer& answer, const Json& range);

}  // namespace tunewright::api
