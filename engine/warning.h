// A warning that belongs to a result: a code for programs, a sentence with the figures for people.
#pragma once

#include <string>

namespace tunewright {

/// How serious a warning is: `bad` means that the result must not be used as it stands.
enum class WarningLevel { warning, bad };

struct Warning {
    std::string code;    ///< kebab-case, stable
    std::string detail;  ///< one sentence with the figure and the cure
    WarningLevel level = WarningLevel::warning;
};

}  // namespace tunewright
