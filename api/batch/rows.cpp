#include "api/batch/rows.h"

#include <array>

#include "api/contract/record.h"
#include "api/csv/csv_writer.h"
#include "api/json/json.h"
#include "api/json/writer.h"

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
constexpr std::array kLater = {"time_unit",        "filter",         "setpoint_filter_T",
                               "settings_to_type", "today_load_IAE", "gain_over_today_percent",
                               "u_unit",           "y_unit"};

/// The settings for the user's own controller as text: "GAIN 2.328 %/%; RESET 93.12 s".
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

/// The load IAE of today's settings; null if the result has none.
const Json* todays_load(const Json& result) {
    const Json* entries = at(result, "/controllers");
    if (entries == nullptr) return nullptr;
    for (const Json& entry : *entries)
        if (entry.value("method", "") == "baseline") return load_of(entry);
    return nullptr;
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
    const Json* lag = at(entry, "/controller/setpoint_filter/T");
    lag != nullptr && lag->is_number() ? out.number(lag->get<double>()) : out.empty();
    const std::string typed = to_type(entry);
    typed.empty() ? out.empty() : out.text(typed);
    const Json *today = todays_load(result), *load = load_of(entry);
    const bool known = today != nullptr && today->is_number();
    known ? out.number(today->get<double>()) : out.empty();
    const bool compared = known && load != nullptr && load->is_number() && today->get<double>() > 0 &&
                          entry.value("method", "") != "baseline";
    compared ? out.number(100 * (1 - load->get<double>() / today->get<double>())) : out.empty();
    add_text(result, "/units/u", out);
    add_text(result, "/units/y", out);
}

/// `entry` of a result; an empty object if there is none.
void add_line(const ResultRow& row, const Json& result, const Json& entry, const Json& error, CsvWriter& out) {
    out.integer(row.index).text(row.id).text(row.name).text(row.status);
    add_text(entry, "/method", out);
    add_text(entry, "/controller/form", out);
    for (const Column& column : kFigures) {
        const Json* figure = at(entry, column.pointer);
        figure != nullptr && figure->is_number() ? out.number(figure->get<double>()) : out.empty();
    }
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
