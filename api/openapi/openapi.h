// The description of the whole interface, built from the contract and from paths.json.
#pragma once

#include <string>

namespace tunewright::api {

/// The document of GET /openapi.json (OpenAPI 3.1).
std::string openapi_json();

}  // namespace tunewright::api
