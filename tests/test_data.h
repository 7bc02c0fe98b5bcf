// Where the tests' data lies.
#pragma once

#include <string>

/// The path of tests/data/`name`.
std::string test_data(const std::string& name);
