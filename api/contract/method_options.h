// Options of a method as JSON: read, written and described from their OptionDescriptions, whatever their shape.
#pragma once

#include <string>
#include <vector>

#include "api/describe/codec.h"
#include "engine/tuning/method/options.h"

namespace tunewright::api {

/// The value of one option, stored at `path`; faults at the reader's place.
void read_option(const Json& value, const OptionDescription& option, const std::string& path, MethodOptions& target,
                 Reader& reader);

/// Every member of the object `value` except "method". `owner` is named by the fault of a member that none describes.
void read_options(const Json& value, const std::vector<OptionDescription>& described, const std::string& owner,
                  MethodOptions& target, Reader& reader);

/// "x is not an option of simc; did you mean ...?"
std::string unknown_option(const std::string& name, const std::string& owner, const std::vector<std::string>& names);

/// Puts a value at its path: "reduction/method" opens an object, "bounds/Kp/1" an array, whose elements before it are
/// null until they are placed.
void place_option(Json& object, const std::string& path, const OptionValue& value);

/// The options of a method as a JSON Schema: an object that allows no other members.
Json options_schema(const std::vector<OptionDescription>& options);

}  // namespace tunewright::api
