// What every call with a body has in common: where it comes from and in which form.
#pragma once

#include <optional>

#include "server/http/message.h"

namespace tunewright::server {

/// The refusal of a call that changes or computes something: 415 where the body is not JSON, 406 where the client takes
/// no JSON. Nothing where all is well.
std::optional<http::Response> refuse_call(const http::Request& request);

/// 406 where the client takes no JSON.
std::optional<http::Response> refuse_form(const http::Request& request);

}  // namespace tunewright::server
