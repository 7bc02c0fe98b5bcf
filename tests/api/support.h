// Helpers of the tests of api/: requests as text, problems as pairs of pointer and sentence.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "api/describe/union.h"
#include "api/json/json.h"
#include "api/service.h"

namespace tunewright::api {

/// The value read by a contract (Description or Union), and the faults found.
template <class T, class Contract>
struct Decoded {
    T value{};
    std::vector<FieldError> faults;
};

template <class T, class Contract>
Decoded<T, Contract> decode(const Contract& contract, std::string_view text) {
    Decoded<T, Contract> out;
    Reader reader;
    contract.read(Json::parse(text), out.value, reader);
    if (const auto problem = reader.problem()) out.faults = problem->errors;
    return out;
}

template <class T, class Contract>
std::string encode(const Contract& contract, const T& value) {
    Writer out;
    contract.write(value, out);
    return out.take();
}

/// The detail at `pointer`; if there is none, a text that lists the faults.
std::string detail_at(const std::vector<FieldError>& faults, std::string_view pointer);

/// A file of tests/data.
std::string data_file(const std::string& name);

/// A request for the FOPDT plant 2 e^(-3s)/(10 s + 1) with further members, such as R"("timeout_s": 5)".
std::string request_with(const std::string& members);

/// Differences between `value` and the schema of the OpenAPI document's component, one sentence each. Supports the
/// keywords that the document uses; any other one is reported too.
std::vector<std::string> schema_faults(const Json& value, const std::string& component);

/// Differences from a separate schema, such as a method's options.
std::vector<std::string> schema_faults(const Json& value, const Json& schema, const Json& document);

}  // namespace tunewright::api
