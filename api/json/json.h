// The one JSON type of the codecs: members keep the order in which they were written.
#pragma once

#include <nlohmann/json.hpp>

namespace tunewright::api {

using Json = nlohmann::ordered_json;

}  // namespace tunewright::api
