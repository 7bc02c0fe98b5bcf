// Values and settings of products as JSON: a number, a word or a switch by its parameter's name.
#pragma once

#include "api/describe/codec.h"
#include "engine/controller/product/settings.h"

namespace tunewright::api {

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
