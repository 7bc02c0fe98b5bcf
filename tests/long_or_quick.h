// Long tests use fewer cases unless all are requested: script/test --long.
#pragma once

#include <cstdlib>
#include <string_view>

/// The first value if LONG_TESTS is 1, else the second: the number of cases of a test, or the step between cases.
inline int long_or_quick(int in_long_run, int in_quick_run) {
    const char* wanted = std::getenv("LONG_TESTS");
    return wanted != nullptr && std::string_view(wanted) == "1" ? in_long_run : in_quick_run;
}
