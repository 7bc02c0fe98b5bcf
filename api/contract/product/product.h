// Products that settings can be converted for, and their settings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/controller/product/settings.h"

namespace tunewright::api {

/// An entry of GET /v1/controllers: enough to search by.
const Description<product::Product>& product_summary_contract();
/// GET /v1/controllers/{id}: everything.
const Description<product::Product>& product_contract();

/// `gain_scheduling` of an entry.
const Description<product::GainScheduling>& gain_scheduling_contract();

// Values and settings as JSON: a number, a word or a switch by its parameter's name.
void write_value(const product::Value& value, Writer& out);
Json value_schema();

/// Whether names and values belong to the product is the product's to say.
Codec<product::Settings> settings_codec();

/// A span that is given ends above its beginning.
void check_span(const char* name, const std::optional<std::vector<double>>& given, Reader& reader);

/// Spans as sent and the unit of the request's times, in seconds.
product::Context context_of(const std::optional<std::vector<double>>& y_span,
                            const std::optional<std::vector<double>>& u_span, double seconds_per_time);

/// The unit of the request's times in seconds; a fault at units/time where it is none that is known.
std::optional<double> seconds_per_time(const std::string& label, Reader& reader);

}  // namespace tunewright::api
