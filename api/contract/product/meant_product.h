// The products that a user may mean by a name that is not an id.
#pragma once

#include <string>
#include <string_view>

namespace tunewright::api {

/// "Did you mean emerson_deltav_standard or emerson_deltav_series?": the products with this text in id, maker, name or
/// family, at most four, else the one with the nearest id. "" if none is near.
std::string meant_product(std::string_view id);

}  // namespace tunewright::api
