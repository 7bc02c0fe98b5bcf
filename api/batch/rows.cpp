#include "api/batch/rows.h"

#include <array>

#include "api/csv/writer.h"
#include "api/json/json.h"
#include "api/json/writer.h"

namespace tunewright::api {
namespace {

struct Column {
    const char* heading;
    const char* pointer;  ///< of a number in an entry of the result
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

/// `entry` of a result; an empty object where there is none.
void add_line(const ResultRow& row, const Json& entry, const Json& error, CsvWriter& out) {
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
    out.end_line();
    return out.take();
}

void append_csv(const ResultRow& row, std::string& out) {
    const Json result = row.result.empty() ? Json() : Json::parse(row.result, nullptr, false);
    const Json error = row.error.empty() ? Json() : Json::parse(row.error, nullptr, false);
    CsvWriter lines;
    const Json* entries = at(result, "/controllers");
    if (entries == nullptr || entries->empty()) {
        add_line(row, Json::object(), error, lines);
    } else {
        for (const Json& entry : *entries)
            add_line(row, entry, entry.contains("error") ? entry["error"] : error, lines);
    }
    out += lines.take();
}

}  // namespace tunewright::api
