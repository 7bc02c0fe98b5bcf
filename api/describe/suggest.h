// Suggests the name that the user meant.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::api {

/// The candidate nearest to `name` (another case, one or two letters changed, or a common synonym such as "dead_time"
/// for L); empty if none is near.
std::string nearest(std::string_view name, std::span<const std::string> candidates);

/// "a, b or c".
std::string listed(std::span<const std::string> names, std::string_view conjunction = "or");

}  // namespace tunewright::api
