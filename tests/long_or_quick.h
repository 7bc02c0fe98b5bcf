// Long tests take fewer cases unless all are asked for: script/test --long.
#pragma once

#include <cstdlib>
#include <string_view>

/// The first where TUNEWRIGHT_LONG is 1, else the second: how many cases a test takes, or the step from one to the
/// next.
inline int long_or_quick(int in_long_run, int in_quick_run) {
    const char* wanted = std::getenv("TUNEWRIGHT_LONG");
    return wanted != nullptr && std::string_view(wanted) == "1" ? in_long_run : in_quick_run;
}
