// Requests and answers about structures, told apart from others.
#pragma once

#include <string>

#include "api/json/json.h"

namespace tunewright::api {

/// The member `structure` of a request for a job, or of a result; "" if it has none.
inline std::string structure_of(const Json& value) {
    const auto found = value.is_object() ? value.find("structure") : value.end();
    return value.is_object() && found != value.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace tunewright::api
