// Tuning methods of the contract: options are read, written and described from the engine's registry, so that a new
// method needs no line here.
#pragma once

#include <string>

#include "api/describe/codec.h"
#include "engine/request/tune.h"

namespace tunewright::api {

/// {"method": "...", options...}; unknown methods and options are refused, ranges checked. "all" takes any method's
/// options.
Codec<MethodRequest> method_request();

inline constexpr std::size_t kMaxMethods = 50;
/// An array of at most kMaxMethods methods, or "all".
Codec<std::vector<MethodRequest>> tune_list();

/// `options` of an entry of this method: those with a default first, in the order in which the method describes them.
void write_options(const std::string& method, const MethodOptions& options, Writer& out);

}  // namespace tunewright::api
