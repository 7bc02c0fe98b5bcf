#include "api/batch/rows.h"

#include <array>

#include "api/contract/record.h"
#include "api/csv/csv_writer.h"
#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/number_text.h"
#include "engine/request/entry.h"

namespace tunewright::api {
namespace {

struct Column {
    const char* heading;
    const char* pointer;  ///< pointer of a number in an entry of the result
};

constexpr std::array kFigures = {
    Column{"Kp", "/controller/Kp"},
    Column{"Ti", "/controller/Ti"},
    Column{"Td", "/controller/Td"},
    Column{"Tf", "/controller/filter/Tf"},
    Column{"b", "/controller/b"},
    Column{"c", "/controller/c"},
    Column{"Ki", "/controller/Ki"},
    Column{"Kd", "/controller/Kd"},
    Column{"Ms", "/robustness/Ms"},
    Column{"Mt", "/robustness/Mt"},
    Column{"gain_margin", "/robustness/gain_margin"},
    Column{"phase_margin_deg", "/robustness/phase_margin_deg"},
    Column{"load_IAE", "/performance/load/IAE"},
    Column{"setpoint_IAE", "/performance/setpoint/IAE"},
    Column{"overshoot_percent", "/performance/setpoint/overshoot_percent"},
    Column{"settling_time", "/performance/setpoint/settling_time"},
};

const Json* at(const Json& value, const char* pointer) {
    const Json::json_pointer place(pointer);
    return value.contains(place) ? &value.at(place) : nullptr;
}

void add_text(const Json& value, const char* pointer, CsvWriter& out) {
    const Json* found = at(value, pointer);
    found != nullptr && found->is_string() ? out.text(found->get_ref<const std::string&>()) : out.empty();
}

/// Columns that were added later stand at the end, so that the earlier ones keep their positions.
constexpr std::array kLater = {
    "time_unit", "filter",         "setpoint_filter_T", "settings_to_type", "today_load_IAE", "gain_over_today_percent",
    "worst_Ms",  "today_settings", "today_Ms",          "u_unit",           "y_unit"};

/// The settings for the user's own controller as text, "GAIN 2.328 %/%; RESET 93.12 s"; "" without a product.
std::string to_type(const Json& entry) {
    const Json* texts = at(entry, "/as_entered/as_typed");
    const Json* units = at(entry, "/as_entered/units");
    std::string out;
    if (texts == nullptr) return out;
    for (const auto& [name, text] : texts->items()) {
        out += (out.empty() ? "" : "; ") + name + " " + text.get<std::string>();
        if (units != nullptr && units->contains(name)) out += " " + units->at(name).get<std::string>();
    }
    return out;
}

/// The load IAE of the loop, which verdicts compare: as implemented if that is known.
const Json* load_of(const Json& entry) {
    return at(entry, entry.contains("implemented") ? "/implemented/performance/load/IAE" : "/performance/load/IAE");
}

/// The same, or the controller with the unit of time: "Kp 0.9; Ti 12 min".
std::string settings_text(const Json& result, const Json& entry) {
    std::string out = to_type(entry);
    const Json* controller = at(entry, "/controller");
    if (!out.empty() || controller == nullptr) return out;
    const Json* unit = at(result, "/units/time");
    const std::string time =
        unit != nullptr && unit->is_string() ? unit->get<std::string>() : Units{}.time_or_default();
    for (const char* name : {"Kp", "Ki", "Kd", "Ti", "Td"}) {
        const Json* value = at(*controller, (std::string("/") + name).c_str());
        if (value == nullptr || !value->is_number()) continue;
        out += (out.empty() ? "" : "; ") + std::string(name) + " " + tunewright::text(value->get<double>(), 6);
        if (*name == 'T') out += " " + time;
    }
    return out;
}

/// The entry of today's settings; null if the result has none.
const Json* todays_entry(const Json& result) {
    const Json* entries = at(result, "/controllers");
    if (entries == nullptr) return nullptr;
    for (const Json& entry : *entries)
        if (entry.value("method", "") == kBaselineMethod) return &entry;
    return nullptr;
}

/// Ms of the loop: as implemented if that is known.
const Json* Ms_of(const Json& entry) {
    return at(entry, entry.contains("implemented") ? "/implemented/robustness/Ms" : "/robustness/Ms");
}

/// The largest Ms on any plant that the loop may meet.
const Json* worst_Ms_of(const Json& entry) {
    const Json* worst = at(entry, entry.contains("implemented") ? "/implemented/region/worst_Ms" : "/region/worst_Ms");
    const Json* own = Ms_of(entry);
    if (worst == nullptr || own == nullptr || !worst->is_number() || !own->is_number()) return worst ? worst : own;
    return worst->get<double>() > own->get<double>() ? worst : own;
}

void add_number(const Json* value, CsvWriter& out) {
    value != nullptr && value->is_number() ? out.number(value->get<double>()) : out.empty();
}

void add_time_unit(const Json& result, CsvWriter& out) {
    const Json* unit = at(result, "/units/time");
    if (result.is_object() && unit == nullptr)
        out.text(Units{}.time_or_default());
    else
        add_text(result, "/units/time", out);
}

void add_later(const Json& result, const Json& entry, CsvWriter& out) {
    add_time_unit(result, out);
    add_text(entry, "/controller/filter/type", out);
    add_number(at(entry, "/controller/setpoint_filter/T"), out);
    const std::string typed = to_type(entry);
    typed.empty() ? out.empty() : out.text(typed);
    const Json* todays = todays_entry(result);
    const Json *today = todays == nullptr ? nullptr : load_of(*todays), *load = load_of(entry);
    const bool known = today != nullptr && today->is_number();
    known ? out.number(today->get<double>()) : out.empty();
    const bool compared = known && load != nullptr && load->is_number() && today->get<double>() > 0 &&
                          entry.value("method", "") != kBaselineMethod;
    compared ? out.number(100 * (1 - load->get<double>() / today->get<double>())) : out.empty();
    add_number(worst_Ms_of(entry), out);
    const std::string before = todays == nullptr ? "" : settings_text(result, *todays);
    before.empty() ? out.empty() : out.text(before);
    add_number(todays == nullptr ? nullptr : worst_Ms_of(*todays), out);
    add_text(result, "/units/u", out);
    add_text(result, "/units/y", out);
}

/// `entry` of a result; an empty object if there is none.
void add_line(const ResultRow& row, const Json& result, const Json& entry, const Json& error, CsvWriter& out) {
    out.integer(row.index).text(row.id).text(row.name).text(row.status);
    add_text(entry, "/method", out);
    add_text(entry, "/controller/form", out);
    for (const Column& column : kFigures) add_number(at(entry, column.pointer), out);
    const Json* warnings = at(entry, "/warnings");
    warnings != nullptr ? out.integer(static_cast<long long>(warnings->size())) : out.empty();
    add_text(error, "/detail", out);
    add_later(result, entry, out);
    out.end_line();
}

}  // namespace

void append_ndjson(const ResultRow& row, std::string& out) {
    Writer line;
    line.begin_object();
    line.key("index");
    line.integer(row.index);
    line.key("id");
    line.text(row.id);
    line.key("name");
    row.name.empty() ? line.null() : line.text(row.name);
    line.key("status");
    line.text(row.status);
    if (!row.result.empty()) {
        line.key("result");
        line.raw(row.result);
    }
    if (!row.error.empty()) {
        line.key("error");
        line.raw(row.error);
    }
    line.end_object();
    out += line.view();
    out += '\n';
}

std::string csv_headings() {
    CsvWriter out;
    for (const char* heading : {"index", "id", "name", "status", "method", "form"}) out.text(heading);
    for (const Column& column : kFigures) out.text(column.heading);
    out.text("warnings").text("error");
    for (const char* heading : kLater) out.text(heading);
    out.end_line();
    return out.take();
}

void append_csv(const ResultRow& row, std::string& out) {
    const Json result = row.result.empty() ? Json() : Json::parse(row.result, nullptr, false);
    const Json error = row.error.empty() ? Json() : Json::parse(row.error, nullptr, false);
    CsvWriter lines;
    const Json* entries = at(result, "/controllers");
    if (entries == nullptr || entries->empty()) {
        add_line(row, result, Json::object(), error, lines);
    } else {
        for (const Json& entry : *entries)
            add_line(row, result, entry, entry.contains("error") ? entry["error"] : error, lines);
    }
    out += lines.take();
}

}  // namespace tunewright::api
