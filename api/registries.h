// The lists that the service returns: methods, and products with the conversions of their settings.
#pragma once

#include <string>
#include <string_view>

#include "api/outcome.h"

namespace tunewright::api {

std::string controllers_json();               ///< GET /v1/controllers: products for which settings can be converted
Answer controller_json(std::string_view id);  ///< GET /v1/controllers/{id}; 404 for none
/// POST /v1/controllers/{id}/settings, .../schedule and .../controller: the settings to type for a controller and for
/// the rows of a schedule, and the controller that typed settings make.
Answer controller_settings_call(std::string_view id, std::string_view body);
Answer controller_schedule_call(std::string_view id, std::string_view body);
Answer controller_twin_call(std::string_view id, std::string_view body);

std::string methods_json();               ///< GET /v1/methods
Answer method_json(std::string_view id);  ///< GET /v1/methods/{id}; 404 for none

}  // namespace tunewright::api
