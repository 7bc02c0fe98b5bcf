// A remark that travels with a result: a code for programs, a sentence with the figures for people.
#pragma once

#include <string>

namespace tunewright {

/// How much a remark weighs: `bad` means that what it belongs to is not to be used as it stands.
enum class WarningLevel { warning, bad };

struct Warning {
    std::string code;    ///< kebab-case, stable
    std::string detail;  ///< one sentence with the figure and what to do
    WarningLevel level = WarningLevel::warning;
};

}  // namespace tunewright
