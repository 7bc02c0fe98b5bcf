#include "api/batch/rows.h"

#include <rapidjson/document.h>

#include <algorithm>
#include <array>

#include "api/contract/record.h"
#include "api/csv/csv_writer.h"
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

/// Columns of a check: texts and numbers of a loop.
constexpr std::array kLoopFigures = {
    Column{"tag", "/tag"},
    Column{"verdict", "/cause/verdict"},
    Column{"confidence", "/cause/confidence"},
    Column{"period", "/oscillation/period"},
    Column{"regularity", "/oscillation/regularity"},
    Column{"size", "/cause/size"},
    Column{"automatic", "/service/automatic"},
    Column{"manual", "/service/manual"},
    Column{"saturated_low", "/service/saturated_low"},
    Column{"saturated_high", "/service/saturated_high"},
    Column{"output_still", "/service/output_still"},
    Column{"measurement_still", "/service/measurement_still"},
    Column{"harris_low", "/performance/harris/low"},
    Column{"harris_high", "/performance/harris/high"},
    Column{"idle_index", "/performance/idle_index"},
    Column{"variability", "/performance/variability"},
    Column{"mean_error", "/performance/mean_error"},
    Column{"travel", "/performance/travel"},
    Column{"reversals", "/performance/reversals"},
};

/// Those of its place in the work list.
constexpr std::array kRankFigures = {
    Column{"gain", "/gain"},
    Column{"share", "/share"},
    Column{"money", "/money"},
};

/// A stored text as a tree. The results of a batch are hundreds of megabytes, and a line of CSV needs only a few of
/// their numbers, so this reader must be fast.
using Value = rapidjson::Value;

std::string_view text_of(const Value& value) { return {value.GetString(), value.GetStringLength()}; }

const Value* member(const Value& value, std::string_view name) {
    if (!value.IsObject()) return nullptr;
    const auto found =
        value.FindMember(Value(rapidjson::StringRef(name.data(), static_cast<rapidjson::SizeType>(name.size()))));
    return found != value.MemberEnd() ? &found->value : nullptr;
}

/// `pointer` as of RFC 6901, without escapes; null if there is no such value.
const Value* at(const Value& value, std::string_view pointer) {
    const Value* here = &value;
    while (here != nullptr && !pointer.empty()) {
        const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
        here = member(*here, pointer.substr(1, end - 1));
        pointer.remove_prefix(end);
    }
    return here;
}

void add_text(const Value& value, std::string_view pointer, CsvWriter& out) {
    const Value* found = at(value, pointer);
    found != nullptr && found->IsString() ? out.text(std::string(text_of(*found))) : out.empty();
}

/// Columns that were added later stand at the end, so that the earlier ones keep their positions.
constexpr std::array kLater = {
    "time_unit", "filter",         "setpoint_filter_T", "settings_to_type", "today_load_IAE", "gain_over_today_percent",
    "worst_Ms",  "today_settings", "today_Ms",          "u_unit",           "y_unit"};

/// The settings for the user's own controller as text, "GAIN 2.328 %/%; RESET 93.12 s"; "" without a product.
std::string to_type(const Value& entry) {
    const Value* texts = at(entry, "/as_entered/as_typed");
    const Value* units = at(entry, "/as_entered/units");
    std::string out;
    if (texts == nullptr) return out;
    for (const auto& [name, text] : texts->GetObject()) {
        if (!out.empty()) out += "; ";
        out.append(text_of(name)).append(" ").append(text_of(text));
        if (const Value* unit = units == nullptr ? nullptr : member(*units, text_of(name)))
            out.append(" ").append(text_of(*unit));
    }
    return out;
}

/// The load IAE of the loop, which verdicts compare: as implemented if that is known.
const Value* load_of(const Value& entry) {
    return at(entry,
              member(entry, "implemented") != nullptr ? "/implemented/performance/load/IAE" : "/performance/load/IAE");
}

/// The same, or the controller with the unit of time: "Kp 0.9; Ti 12 min".
std::string settings_text(const Value& result, const Value& entry) {
    std::string out = to_type(entry);
    const Value* controller = at(entry, "/controller");
    if (!out.empty() || controller == nullptr) return out;
    const Value* unit = at(result, "/units/time");
    const std::string time =
        unit != nullptr && unit->IsString() ? std::string(text_of(*unit)) : Units{}.time_or_default();
    for (const char* name : {"Kp", "Ki", "Kd", "Ti", "Td"}) {
        const Value* value = member(*controller, name);
        if (value == nullptr || !value->IsNumber()) continue;
        out += (out.empty() ? "" : "; ") + std::string(name) + " " + tunewright::text(value->GetDouble(), 6);
        if (*name == 'T') out += " " + time;
    }
    return out;
}

bool is_todays(const Value& entry) {
    const Value* method = member(entry, "method");
    return method != nullptr && method->IsString() && text_of(*method) == kBaselineMethod;
}

/// The entry of today's settings; null if the result has none.
const Value* todays_entry(const Value& result) {
    const Value* entries = at(result, "/controllers");
    if (entries == nullptr) return nullptr;
    for (const Value& entry : entries->GetArray())
        if (is_todays(entry)) return &entry;
    return nullptr;
}

/// The largest Ms on any plant that the loop may meet, as the ranking judges it.
const Value* worst_Ms_of(const Value& entry) { return at(entry, "/standing/Ms"); }

void add_number(const Value* value, CsvWriter& out) {
    value != nullptr && value->IsNumber() ? out.number(value->GetDouble()) : out.empty();
}

void add_time_unit(const Value& result, CsvWriter& out) {
    if (result.IsObject() && at(result, "/units/time") == nullptr)
        out.text(Units{}.time_or_default());
    else
        add_text(result, "/units/time", out);
}

void add_later(const Value& result, const Value& entry, CsvWriter& out) {
    add_time_unit(result, out);
    add_text(entry, "/controller/filter/type", out);
    add_number(at(entry, "/controller/setpoint_filter/T"), out);
    const std::string typed = to_type(entry);
    typed.empty() ? out.empty() : out.text(typed);
    const Value* todays = todays_entry(result);
    const Value *today = todays == nullptr ? nullptr : load_of(*todays), *load = load_of(entry);
    const bool known = today != nullptr && today->IsNumber();
    known ? out.number(today->GetDouble()) : out.empty();
    const bool compared = known && load != nullptr && load->IsNumber() && today->GetDouble() > 0 && !is_todays(entry);
    compared ? out.number(100 * (1 - load->GetDouble() / today->GetDouble())) : out.empty();
    add_number(worst_Ms_of(entry), out);
    const std::string before = todays == nullptr ? "" : settings_text(result, *todays);
    before.empty() ? out.empty() : out.text(before);
    add_number(todays == nullptr ? nullptr : worst_Ms_of(*todays), out);
    add_text(result, "/units/u", out);
    add_text(result, "/units/y", out);
}

/// `entry` of a result; an empty object if there is none.
void add_line(const ResultRow& row, const Value& result, const Value& entry, const Value& error, CsvWriter& out) {
    out.integer(row.index).text(row.id).text(row.name).text(row.status);
    add_text(entry, "/method", out);
    add_text(entry, "/controller/form", out);
    for (const Column& column : kFigures) add_number(at(entry, column.pointer), out);
    const Value* warnings = at(entry, "/warnings");
    warnings != nullptr && warnings->IsArray() ? out.integer(warnings->Size()) : out.empty();
    add_text(error, "/detail", out);
    add_later(result, entry, out);
    out.end_line();
}

/// `loop` and `rank`: empty objects if there are none.
void add_loop_line(const ResultRow& row, const Value& result, const Value& loop, const Value& rank, const Value& error,
                   CsvWriter& out) {
    out.integer(row.index).text(row.id).text(row.name).text(row.status);
    for (const Column& column : kLoopFigures) {
        const Value* value = at(loop, column.pointer);
        value != nullptr && value->IsString() ? add_text(loop, column.pointer, out) : add_number(value, out);
    }
    for (const Column& column : kRankFigures) add_number(at(rank, column.pointer), out);
    add_text(loop, "/action/code", out);
    add_text(loop, "/action/owner", out);
    const Value* remarks = at(loop, "/quality/remarks");
    remarks != nullptr && remarks->IsArray() ? out.integer(remarks->Size()) : out.empty();
    add_text(error, "/detail", out);
    add_time_unit(result, out);
    add_text(result, "/units/u", out);
    add_text(result, "/units/y", out);
    out.end_line();
}

/// The member of `ranking` about the loop at this place; null if there is none.
const Value* rank_of(const Value& result, std::size_t place) {
    const Value* ranking = at(result, "/ranking");
    if (ranking == nullptr || !ranking->IsArray()) return nullptr;
    for (const Value& rank : ranking->GetArray()) {
        const Value* loop = member(rank, "loop");
        if (loop != nullptr && loop->IsUint64() && loop->GetUint64() == place) return &rank;
    }
    return nullptr;
}

struct RowTrees {
    rapidjson::Document result, error;

    explicit RowTrees(const ResultRow& row) {
        read(result, row.result);
        read(error, row.error);
    }

private:
    static void read(rapidjson::Document& tree, std::string_view text) {
        if (!text.empty()) tree.Parse<rapidjson::kParseFullPrecisionFlag>(text.data(), text.size());
        if (tree.HasParseError()) tree.SetNull();
    }
};

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
    const RowTrees trees(row);
    const Value &result = trees.result, &error = trees.error;
    CsvWriter lines;
    const Value* entries = at(result, "/controllers");
    if (entries == nullptr || !entries->IsArray() || entries->Empty()) {
        add_line(row, result, Value(rapidjson::kObjectType), error, lines);
    } else {
        for (const Value& entry : entries->GetArray()) {
            const Value* own = member(entry, "error");
            add_line(row, result, entry, own != nullptr ? *own : error, lines);
        }
    }
    out += lines.take();
}

std::string check_csv_headings() {
    CsvWriter out;
    for (const char* heading : {"index", "id", "name", "status"}) out.text(heading);
    for (const Column& column : kLoopFigures) out.text(column.heading);
    for (const Column& column : kRankFigures) out.text(column.heading);
    for (const char* heading : {"action", "owner", "remarks", "error", "time_unit", "u_unit", "y_unit"})
        out.text(heading);
    out.end_line();
    return out.take();
}

void append_check_csv(const ResultRow& row, std::string& out) {
    const RowTrees trees(row);
    const Value none(rapidjson::kObjectType);
    const Value* loops = at(trees.result, "/loops");
    CsvWriter lines;
    if (loops == nullptr || !loops->IsArray() || loops->Empty()) {
        add_loop_line(row, trees.result, none, none, trees.error, lines);
    } else {
        for (rapidjson::SizeType place = 0; place < loops->Size(); ++place) {
            const Value* rank = rank_of(trees.result, place);
            add_loop_line(row, trees.result, (*loops)[place], rank == nullptr ? none : *rank, trees.error, lines);
        }
    }
    out += lines.take();
}

}  // namespace tunewright::api
