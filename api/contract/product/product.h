// Controllers as they are built: what there is, and the calls that convert their settings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/contract/range/range_request.h"
#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/controller/pid.h"
#include "engine/controller/product/settings.h"

namespace tunewright::api {

/// An entry of GET /v1/controllers: enough to search by.
const Description<product::Product>& product_summary_contract();
/// GET /v1/controllers/{id}: everything.
const Description<product::Product>& product_contract();

/// `gain_scheduling` of an entry.
const Description<product::GainScheduling>& gain_scheduling_contract();

/// What both conversions take beside controller or settings.
struct BlockContext {
    std::optional<Units> units;
    std::optional<std::vector<double>> y_span, u_span;
    std::optional<double> sample_time;  ///< in units.time
    product::Context context;           ///< of these, set in every request that was read without a fault
};

struct SettingsRequest : BlockContext {
    std::optional<Controller> controller;  ///< set in every request that was read without a fault
    bool nearest = false;
};
const Description<SettingsRequest>& settings_request_contract();

/// What is to be typed, also beside an entry of a result.
struct SettingsAnswer {
    const product::Product* product = nullptr;
    product::Settings settings;  ///< in full precision
    product::Settings typed;     ///< as they are typed
    IdealPid realised;
    std::vector<product::Note> notes;
};
const Description<SettingsAnswer>& settings_answer_contract();

/// The rows of a schedule that are to be typed.
struct ScheduleSettingsRequest : BlockContext {
    std::vector<GivenRow> rows;
    Interpolation interpolation = Interpolation::linear_in_gains;
    bool nearest = false;
};
const Description<ScheduleSettingsRequest>& schedule_settings_request_contract();

struct ScheduleSettingsAnswer {
    const product::Product* product = nullptr;
    product::ConvertedSchedule schedule;
};
const Description<ScheduleSettingsAnswer>& schedule_settings_answer_contract();

struct TwinRequest : BlockContext {
    product::Settings settings;  ///< as sent: names and values are the product's to judge
};
const Description<TwinRequest>& twin_request_contract();

struct TwinAnswer {
    IdealPid controller;
    std::vector<product::Note> notes;
};
const Description<TwinAnswer>& twin_answer_contract();

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
