// The sections of the report, each in its own source.
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
/// The first finding of the entry, which has its level, and those that speak against the change: warnings, and an
/// overshoot with its cure.
Html reason_section(const ReportInput& subject);
/// The title of a product, "Emerson DeltaV PID, FORM Series"; a maker whose name is part of the product's is not
/// repeated.
std::string product_title(const product::Product& product);
/// The controller into which the new settings are typed; "" if it is not known. Settings that the product of the
/// request cannot take are not its own.
std::string controller_words(const ReportInput& subject);
/// `if_known`: the column of today's settings is shown only if they are known. `always`: otherwise it is empty, to be
/// written into.
enum class TodayColumn { if_known, always };
/// Today's settings and the new ones, with the ranges for which they are valid.
Html settings_section(const ReportInput& subject, TodayColumn column);
/// How to undo the change.
Html way_back_section(const ReportInput& subject);
/// New and today's settings in the ideal, parallel and series forms.
Html forms_section(const ReportInput& subject);
Html figures_section(const ReportInput& subject);
/// The figures of a change sheet, today's next to the new ones, with one drawing.
Html effect_section(const ReportInput& subject);
/// y over the recorded time if the entry has a replay, else after the load step; empty without traces.
Html effect_drawing(const ReportInput& subject);
/// Set-point and load step, y and u of each.
std::vector<Plot> response_plots(const ReportInput& subject);
Html responses_section(const ReportInput& subject);
/// y with the set point, and u with its limits, of the user's own step; without lines if the entry has none.
std::vector<Plot> own_step_plots(const ReportInput& subject);
/// The user's own step: the step itself, its figures and its course; empty if the request has none.
Html own_step_section(const ReportInput& subject);
Html robustness_section(const ReportInput& subject);
Html plant_section(const ReportInput& subject);
Html method_section(const ReportInput& subject);
Html assumptions_section(const ReportInput& subject);
/// The report of an operating range without its head and its request.
Html range_sections(const ReportInput& subject);
/// The report of a check without its head and its request: the plant's work list, then a page for each loop.
Html check_sections(const ReportInput& subject);
/// The report of a structure without its head and its request.
Html structure_sections(const ReportInput& subject);
/// The whole request, as a file to save, as text and as a command. `origin`: of the service.
Html request_section(const Json& request, const std::string& origin);

}  // namespace tunewright::api
