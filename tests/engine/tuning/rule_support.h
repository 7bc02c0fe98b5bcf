// Common helpers of the tests of the closed-form rules.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"

namespace tunewright::test {

using Given = std::vector<std::pair<std::string, OptionValue>>;

inline MethodOptions options_of(const Given& given) {
    MethodOptions options;
    for (const auto& [path, value] : given) options.set(path, value);
    return options;
}

inline Expected<TunedController> tuned(const std::string& id, const Plant& plant, const Given& given = {}) {
    return find_method(id)->tune({plant, *LinearPlant::make(plant), std::nullopt}, options_of(given), {});
}

/// A word as an option.
inline std::pair<std::string, OptionValue> word(const std::string& path, const std::string& value) {
    return {path, value};
}

inline const Given kP{word("controller", "P")}, kPI{word("controller", "PI")}, kPID{word("controller", "PID")};

/// Kp, Ti, Td within a relative tolerance; infinite Ti: no integral action.
inline void expect_settings(const Expected<TunedController>& answer, double Kp, double Ti, double Td,
                            double tolerance = 1e-9) {
    ASSERT_TRUE(answer) << answer.error().message;
    const IdealPid& pid = answer->controller;
    EXPECT_NEAR(pid.Kp, Kp, tolerance * std::abs(Kp));
    if (std::isinf(Ti))
        EXPECT_FALSE(pid.has_integral());
    else
        EXPECT_NEAR(pid.Ti, Ti, tolerance * Ti);
    EXPECT_NEAR(pid.Td, Td, tolerance * Td);
}

inline bool warns(const TunedController& answer, const std::string& code) {
    return std::ranges::any_of(answer.warnings, [&](const Warning& w) { return w.code == code; });
}

}  // namespace tunewright::test
