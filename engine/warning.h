// A remark that travels with a result: a code for programs, a sentence with the figures for people.
#pragma once

#include <map>
#include <string>

namespace tunewright {

struct Warning {
    std::string code;    ///< kebab-case, stable
    std::string detail;  ///< one sentence with the figure and what to do
};

/// Field name -> why that quantity is null (infinite or undefined).
using WhyNull = std::map<std::string, std::string>;

}  // namespace tunewright
