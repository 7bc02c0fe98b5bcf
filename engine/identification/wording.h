// Numbers inside the sentences of this room.
#pragma once

#include <cstdio>
#include <string>

namespace tunewright {

/// `digits` significant digits, as people write them.
inline std::string number_text(double x, int digits = 4) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    return text;
}

}  // namespace tunewright
