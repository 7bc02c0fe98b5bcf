// The sections of the report, each in a source of its own.
#pragma once

#include <string>
#include <vector>

#include "api/json/json.h"
#include "api/report/html.h"
#include "api/report/plot.h"
#include "api/report/report_input.h"
#include "engine/controller/product/product.h"

namespace tunewright::api {

Html verdict_section(const ReportInput& subject);
/// "Emerson DeltaV PID, FORM Series"; a maker after whom the product is named is not said twice.
std::string product_title(const product::Product& product);
/// The same of the user's own controller, as the request names it; "" where it does not.
std::string controller_words(const ReportInput& subject);
/// From today's settings to the new ones, with the ranges that they rest on.
Html settings_section(const ReportInput& subject);
/// New and today's settings in the ideal, parallel and series forms.
Html forms_section(const ReportInput& subject);
Html figures_section(const ReportInput& subject);
/// Set-point and load step, y and u of each.
std::vector<Plot> response_plots(const ReportInput& subject);
Html responses_section(const ReportInput& subject);
Html robustness_section(const ReportInput& subject);
Html plant_section(const ReportInput& subject);
Html method_section(const ReportInput& subject);
Html assumptions_section(const ReportInput& subject);
/// All that a report says of an operating range but its head and its request.
Html range_sections(const ReportInput& subject);
/// The request whole, as a file to take out, as text and as a command. `origin`: of the service.
Html request_section(const Json& request, const std::string& origin);

}  // namespace tunewright::api
