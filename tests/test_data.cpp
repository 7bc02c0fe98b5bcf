#include "tests/test_data.h"

std::string test_data(const std::string& name) { return std::string(TEST_DATA) + "/" + name; }
