// Where the tests' data lies. The build writes the source of this function (CMakeLists.txt).
#pragma once

#include <string>

/// The path of tests/data/`name`.
std::string test_data(const std::string& name);
