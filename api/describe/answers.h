// The parts of a type that only answers need: values that others are drawn over, the mark of what is always there.
#pragma once

#include <vector>

#include "api/describe/codec.h"

namespace tunewright::api {

/// In the schema of a type that requests may have as well: the names of the members that are never left out when it is
/// written. Where no request has the type, the document has them as `required` instead.
inline constexpr const char* kWritten = "x-written";

/// Times, frequencies and whatever else others are drawn over: six significant digits each, as in trace(), but never
/// null.
inline Codec<std::vector<double>> abscissa() {
    Codec<std::vector<double>> codec = trace();
    codec.schema = times_trace().schema;
    return codec;
}

/// The same, left out where there is none.
inline Codec<std::vector<double>> abscissa_if_any() {
    return unless<std::vector<double>>(abscissa(), [](const std::vector<double>& values) { return values.empty(); });
}

}  // namespace tunewright::api
