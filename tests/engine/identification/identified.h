// Identifies a record in a test: the model, or the refusal.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>

#include "engine/identification/identify.h"

namespace tunewright::testing {

/// The model identified from the record; the test fails if there is none.
inline IdentifiedModel identified(const Record& record, ModelChoice model = ModelChoice::automatic) {
    IdentifyOptions options;
    options.model = model;
    auto result = identify(record, options, {});
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return result ? *result : IdentifiedModel{};
}

/// The model's plant, which must be of this type.
template <class Type>
Type plant_as(const IdentifiedModel& model) {
    EXPECT_TRUE(std::holds_alternative<Type>(model.plant)) << model.choice_reason;
    return std::holds_alternative<Type>(model.plant) ? std::get<Type>(model.plant) : Type{};
}

inline bool warns(const IdentifiedModel& model, const std::string& code) {
    return std::any_of(model.warnings.begin(), model.warnings.end(), [&](const Warning& w) { return w.code == code; });
}

/// The refusal of the record; the test fails if it is not refused.
inline Error refusal(const Record& record, const IdentifyOptions& options = {}) {
    auto result = identify(record, options, {});
    EXPECT_FALSE(result);
    return result ? Error{} : result.error();
}

}  // namespace tunewright::testing
