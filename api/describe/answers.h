// Codecs of values that only answers need: abscissae of traces, and the mark of members that are always written.
#pragma once

#include <vector>

#include "api/describe/codec.h"

namespace tunewright::api {

/// In the schema of a type that requests may have too: the names of the members that are never left out when it is
/// written. If no request has the type, the document lists them as `required` instead.
inline constexpr const char* kWritten = "x-written";

/// Times, frequencies and other abscissae: six significant digits each, as in trace(), but never null.
inline Codec<std::vector<double>> abscissa() {
    Codec<std::vector<double>> codec = trace();
    codec.schema = times_trace().schema;
    return codec;
}

/// An abscissa that is left out if it is empty.
inline Codec<std::vector<double>> abscissa_if_any() {
    return unless<std::vector<double>>(abscissa(), [](const std::vector<double>& values) { return values.empty(); });
}

}  // namespace tunewright::api
