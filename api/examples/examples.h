// The examples: complete requests about well-known loops.
#pragma once

#include <string>
#include <string_view>

#include "api/outcome.h"

namespace tunewright::api {

std::string examples_json();  ///< GET /v1/examples
/// The request of the example with that id, or with that number from 1; 404 for none.
Answer example_request(std::string_view which);

}  // namespace tunewright::api
