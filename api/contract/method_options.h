// Options of a method as JSON: a codec for each, made from its OptionDescription, whatever its shape.
#pragma once

#include <string>
#include <vector>

#include "api/describe/codec.h"
#include "engine/tuning/method/options.h"

namespace tunewright::api {

/// Reads and describes an option, which is stored under its name. `option` must outlive the codec.
Codec<MethodOptions> option_codec(const OptionDescription& option);

/// Reads every member of the object `value` except "method". `owner` is the name in the fault of an unknown member.
void read_options(const Json& value, const std::vector<OptionDescription>& described, const std::string& owner,
                  MethodOptions& target, Reader& reader);

/// The fault of an unknown option: "x is not an option of simc; did you mean ...?"
std::string unknown_option(const std::string& name, const std::string& owner, const std::vector<std::string>& names);

/// Puts a value at its path: "reduction/method" opens an object, "bounds/Kp/1" an array.
void place_option(Json& object, const std::string& path, const OptionValue& value);

/// The options of a method as a JSON Schema: an object that allows no other members.
Json options_schema(const std::vector<OptionDescription>& options);

}  // namespace tunewright::api
