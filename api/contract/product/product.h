// Products that settings can be converted for, and their settings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/controller/product/settings.h"

namespace tunewright::api {

/// An entry of GET /v1/controllers: the fields for a search.
const Description<product::Product>& product_summary_contract();
/// GET /v1/controllers/{id}: all fields.
const Description<product::Product>& product_contract();

/// The field `gain_scheduling` of an entry.
const Description<product::GainScheduling>& gain_scheduling_contract();

// Writes a value as JSON: a number, a word or a switch.
void write_value(const product::Value& value, Writer& out);
Json value_schema();

/// Reads any names and values: the product checks them.
Codec<product::Settings> settings_codec();

/// Checks that a span, if given, ends above its beginning.
void check_span(const char* name, const std::optional<std::vector<double>>& given, Reader& reader);

/// Spans as sent, and the unit of the request's times in seconds.
product::Context context_of(const std::optional<std::vector<double>>& y_span,
                            const std::optional<std::vector<double>>& u_span, double seconds_per_time);

/// The unit of the request's times in seconds; a fault at units/time if it is not a known one.
std::optional<double> seconds_per_time(const std::string& label, Reader& reader);

}  // namespace tunewright::api
