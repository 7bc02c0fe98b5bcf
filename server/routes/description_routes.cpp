#include "api/examples/examples.h"
#include "api/openapi/openapi.h"
#include "api/registries.h"
#include "api/service.h"
#include "server/http/app/compression.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;

/// A text that is constant for the life of the process.
http::Handler constant(std::string body) {
    return [text = http::ConstantBody(std::move(body), "application/json")](const Call& call) {
        if (auto refusal = refuse_form(call.request)) return *std::move(refusal);
        return text.respond(call.request).set("Cache-Control", "no-cache");
    };
}

/// The description of the item whose id is in the path.
http::Handler one_of(api::Answer (*describe)(std::string_view)) {
    return [describe](const Call& call) {
        if (auto refusal = refuse_form(call.request)) return *std::move(refusal);
        return response_of(describe(call.path.at("id")));
    };
}

}  // namespace

void add_description_routes(http::Router& router) {
    router.quick("GET", "/openapi.json", constant(api::openapi_json()));
    router.quick("GET", "/v1/methods", constant(api::methods_json()));
    router.quick("GET", "/v1/examples", constant(api::examples_json()));
    router.quick("GET", "/v1/controllers", constant(api::controllers_json()));
    router.add("GET", "/v1/methods/{id}", one_of(api::method_json));
    router.add("GET", "/v1/controllers/{id}", one_of(api::controller_json));
}

}  // namespace tunewright::server
