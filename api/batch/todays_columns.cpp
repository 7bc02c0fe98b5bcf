#include "api/batch/todays_columns.h"

#include <algorithm>
#include <array>
#include <utility>

#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

/// Headings in lower case, and their members in `baseline`.
using Member = std::pair<std::string_view, const char*>;
constexpr std::array<Member, 15> kMembers = {{{"kp", "Kp"},
                                              {"ki", "Ki"},
                                              {"kd", "Kd"},
                                              {"ti", "Ti"},
                                              {"td", "Td"},
                                              {"tf", "filter/Tf"},
                                              {"b", "b"},
                                              {"c", "c"},
                                              {"form", "form"},
                                              {"product", "product"},
                                              {"sample time", "sample_time"},
                                              {"y low", "y_span/0"},
                                              {"y high", "y_span/1"},
                                              {"u low", "u_span/0"},
                                              {"u high", "u_span/1"}}};

/// Length of "today", "today's" or "today:" with the blanks after it; 0 if there is none.
std::size_t length_of_mark(std::string_view name) {
    for (const std::string_view mark : {"today's", "today:", "today"})
        if (name.starts_with(mark)) return std::min(name.size(), name.find_first_not_of(" _", mark.size()));
    return 0;
}

bool is_word(const TodaysColumn& column) { return column.member == "form" || column.member == "product"; }

/// A number, true or false, else the text.
Json cell_value(std::string_view cell, DecimalSign sign) {
    double number = 0;
    if (read_cell_number(cell, number, sign, unit_suffix(cell))) return number;
    if (cell == "true" || cell == "TRUE") return true;
    if (cell == "false" || cell == "FALSE") return false;
    return std::string(cell);
}

std::string_view cell_of(const TodaysColumn& column, const std::vector<std::string_view>& cells) {
    return column.cell < cells.size() && !is_missing(cells[column.cell]) ? cells[column.cell] : std::string_view();
}

void put(Json& object, std::string_view path, Json value) {
    const std::size_t slash = path.find('/');
    if (slash == path.npos) {
        object[std::string(path)] = std::move(value);
        return;
    }
    const std::string head(path.substr(0, slash));
    if (head == "filter") object[head]["type"] = "derivative";
    object[head][std::string(path.substr(slash + 1))] = std::move(value);
}

void add_range(const TodaysColumn& column, Json value, Json& implement) {
    const std::string span = column.member.substr(0, column.member.find('/'));
    if (!implement.contains(span)) implement[span] = Json::array({nullptr, nullptr});
    implement[span][column.member.ends_with('1') ? 1 : 0] = std::move(value);
}

FieldError no_number(const char* object, const TodaysColumn& column, std::string_view cell) {
    return {object + column.member, column.name + " is \"" + std::string(cell) + "\"; it must be a number, or empty."};
}

}  // namespace

bool TodaysColumn::is_of_controller() const {
    return member == "product" || member == "sample_time" || member.find("_span/") != std::string::npos;
}

std::optional<TodaysColumn> todays_column(const Heading& heading) {
    std::string name = heading.name;
    const std::size_t mark = length_of_mark(name);
    name.erase(0, mark);
    std::ranges::replace(name, '_', ' ');
    const auto known = std::ranges::find(kMembers, std::string_view(name), &Member::first);
    if (known == kMembers.end() && (mark == 0 || name.empty())) return std::nullopt;
    // Names of settings are the product's own, with capitals and endings that look like a unit ("Td_min").
    std::string written = heading.text.substr(mark);
    if (const std::size_t unit = written.find_last_of("[(");
        unit != written.npos && (written.ends_with(']') || written.ends_with(')')))
        written.erase(unit);
    while (written.ends_with(' ')) written.pop_back();
    return TodaysColumn{.name = written, .member = known == kMembers.end() ? "" : known->second, .unit = heading.unit};
}

Json own_controller(const std::vector<TodaysColumn>& columns, const std::vector<std::string_view>& cells,
                    DecimalSign sign, std::vector<FieldError>& faults) {
    Json implement = Json::object();
    for (const TodaysColumn& column : columns) {
        const std::string_view cell = cell_of(column, cells);
        if (!column.is_of_controller() || cell.empty()) continue;
        Json value = is_word(column) ? Json(std::string(cell)) : cell_value(cell, sign);
        if (!is_word(column) && !value.is_number())
            faults.push_back(no_number("/implement/", column, cell));
        else if (column.member.find('/') != std::string::npos)
            add_range(column, std::move(value), implement);
        else
            implement[column.member] = std::move(value);
    }
    return implement;
}

Json todays_settings(const std::vector<TodaysColumn>& columns, const std::vector<std::string_view>& cells,
                     DecimalSign sign, const std::string& product, std::vector<FieldError>& faults) {
    Json baseline = Json::object();
    for (const TodaysColumn& column : columns) {
        const std::string_view cell = cell_of(column, cells);
        if (cell.empty() || column.is_of_controller()) continue;
        Json value = is_word(column) ? Json(std::string(cell)) : cell_value(cell, sign);
        if (!product.empty())
            baseline["settings"][column.name] = std::move(value);
        else if (!is_word(column) && !value.is_number())
            faults.push_back(no_number("/baseline/", column, cell));
        else
            put(baseline, column.member, std::move(value));
    }
    if (baseline.empty()) return nullptr;
    if (!product.empty())
        baseline["product"] = product;
    else if (!baseline.contains("form"))
        baseline["form"] = baseline.contains("Ki") ? "parallel" : "ideal";
    return baseline;
}

}  // namespace tunewright::api
