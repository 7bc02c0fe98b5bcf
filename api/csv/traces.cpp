#include "api/csv/traces.h"

#include <algorithm>
#include <map>
#include <vector>

#include "api/csv/csv_writer.h"
#include "api/json/json.h"

namespace tunewright::api {
namespace {

struct Trace {
    std::string heading;
    const Json* values;
};

/// Traces over the same points.
struct Block {
    std::string label;  ///< of the first entry with these points
    const Json* points;
    std::vector<Trace> traces;
};

const Json* at(const Json& value, const std::string& pointer) {
    const Json::json_pointer place(pointer);
    return value.contains(place) && value.at(place).is_array() ? &value.at(place) : nullptr;
}

class Table {
public:
    explicit Table(const Json& result) : units_(result.value("units", Json::object())) {}

    /// Adds a trace; does nothing if one of the two is missing.
    void add(const std::string& label, const Json* points, const std::string& heading, const Json* values) {
        if (points == nullptr || values == nullptr) return;
        auto block =
            std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& known) { return *known.points == *points; });
        if (block == blocks_.end()) block = blocks_.insert(block, {label, points, {}});
        block->traces.push_back({label.empty() ? heading : label + " " + heading, values});
    }

    /// The quantity with its unit, "y" -> "y [degC]", if the request names the unit.
    std::string with_unit(const std::string& quantity, const char* unit, const std::string& fallback = {}) const {
        const std::string name = units_.value(unit, fallback);
        return name.empty() ? quantity : quantity + " [" + name + "]";
    }

    /// The same for a quantity in u/y: "|CS| [%/degC]", if both are named.
    std::string with_quotient(const std::string& quantity) const {
        const std::string u = units_.value("u", ""), y = units_.value("y", "");
        return u.empty() || y.empty() ? quantity : quantity + " [" + u + "/" + y + "]";
    }

    std::optional<std::string> text(const std::string& points_heading) const {
        if (blocks_.empty()) return std::nullopt;
        CsvWriter out;
        std::size_t lines = 0;
        for (const Block& block : blocks_) {
            out.text(blocks_.size() == 1 || block.label.empty() ? points_heading : block.label + " " + points_heading);
            for (const Trace& trace : block.traces) out.text(trace.heading);
            lines = std::max(lines, block.points->size());
        }
        out.end_line();
        for (std::size_t i = 0; i < lines; ++i) {
            for (const Block& block : blocks_) {
                add_point(*block.points, i, out);
                for (const Trace& trace : block.traces) add(*trace.values, i, out);
            }
            out.end_line();
        }
        return out.take();
    }

private:
    static void add(const Json& values, std::size_t i, CsvWriter& out) {
        i < values.size() && values[i].is_number() ? out.trace_number(values[i].get<double>()) : out.empty();
    }

    /// Writes the numbers unchanged: times may have more than six digits.
    static void add_point(const Json& points, std::size_t i, CsvWriter& out) {
        i < points.size() && points[i].is_number() ? out.number(points[i].get<double>()) : out.empty();
    }

    Json units_;
    std::vector<Block> blocks_;
};

/// Distinct labels of the entries: "robust", "robust (2)".
std::vector<std::string> labels(const Json& controllers) {
    std::vector<std::string> out;
    std::map<std::string, int> seen;
    for (const Json& entry : controllers) {
        const std::string method = entry.value("method", "");
        const int count = ++seen[method];
        out.push_back(count == 1 ? method : method + " (" + std::to_string(count) + ")");
    }
    return out;
}

void add_responses(const Json& entry, const std::string& label, Table& table) {
    for (const std::string step : {"setpoint", "load"}) {
        for (const std::string quantity : {"y", "u"}) {
            const std::string place = "/responses/" + step + "/";
            table.add(label, at(entry, place + "t"), step + " " + table.with_unit(quantity, quantity.c_str()),
                      at(entry, place + quantity));
        }
    }
    for (const std::string quantity : {"r", "y", "u"})
        table.add(label, at(entry, "/own_step/trace/t"),
                  "own step " + table.with_unit(quantity, quantity == "u" ? "u" : "y"),
                  at(entry, "/own_step/trace/" + quantity));
}

void add_frequency(const Json& entry, const std::string& label, Table& table) {
    const Json* omega = at(entry, "/frequency/omega");
    table.add(label, omega, "L re", at(entry, "/frequency/L/re"));
    table.add(label, omega, "L im", at(entry, "/frequency/L/im"));
    table.add(label, omega, "L phase [deg]", at(entry, "/frequency/L/phase_deg"));
    for (const std::string name : {"S", "T"})
        table.add(label, omega, "|" + name + "|", at(entry, "/frequency/" + name + "_abs"));
    table.add(label, omega, table.with_quotient("|CS|"), at(entry, "/frequency/CS_abs"));
}

}  // namespace

std::optional<std::string> traces_csv(std::string_view result_json, Traces traces) {
    const Json result = Json::parse(result_json, nullptr, false);
    if (!result.is_object()) return std::nullopt;
    Table table(result);
    const std::string time = table.with_unit("t", "time", "s");
    if (traces == Traces::model) {
        const Json* t = at(result, "/model/fit/t");
        table.add({}, t, table.with_unit("u", "u"), at(result, "/model/fit/u"));
        table.add({}, t, table.with_unit("y", "y"), at(result, "/model/fit/y"));
        table.add({}, t, table.with_unit("y_model", "y"), at(result, "/model/fit/y_model"));
        return table.text(time);
    }
    const Json none = Json::array();
    const Json* controllers = at(result, "/controllers");
    if (controllers == nullptr) controllers = &none;
    const std::vector<std::string> names = labels(*controllers);
    for (std::size_t i = 0; i < controllers->size(); ++i)
        (traces == Traces::responses ? add_responses : add_frequency)((*controllers)[i], names[i], table);
    if (traces == Traces::responses) return table.text(time);
    return table.text("omega [rad/" + time.substr(3));
}

}  // namespace tunewright::api
