// A number inside a sentence.
#pragma once

#include <cstdio>
#include <string>

namespace tunewright {

/// Four significant digits, shortest form: "0.25", "1.3e-05".
inline std::string text(double x) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.4g", x);
    return buffer;
}

}  // namespace tunewright
