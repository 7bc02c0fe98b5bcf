// The folder of the tests' data. The build generates the source of this function (CMakeLists.txt).
#pragma once

#include <string>

/// The path of tests/data/`name`.
std::string test_data(const std::string& name);
