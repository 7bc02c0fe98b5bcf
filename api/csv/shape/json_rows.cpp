#include "api/csv/shape/shapes.h"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <vector>

#include "api/csv/cell.h"
#include "api/json/json.h"

namespace tunewright::api {
namespace {

std::string cell_of(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_null()) return {};
    return value.dump();
}

class JsonTable {
public:
    void add(const Json& row) {
        cells_.clear();
        flatten(row, "");
        if (!cells_.empty()) rows_.push_back(std::move(cells_));
    }

    ShapedText table(bool with_headings) const {
        ShapedText out;
        std::vector<std::string_view> line(headings_.begin(), headings_.end());
        if (with_headings) add_line(out, line, 1);
        for (std::size_t i = 0; i < rows_.size() && out.fault.empty(); ++i) {
            line.assign(headings_.size(), {});
            for (const auto& [column, cell] : rows_[i]) line[column] = cell;
            add_line(out, line, static_cast<int>(i) + 1);
        }
        return out;
    }

    std::size_t rows() const { return rows_.size(); }
    std::size_t columns() const { return headings_.size(); }

private:
    void flatten(const Json& value, const std::string& name) {
        const std::string front = name.empty() ? "" : name + ".";
        if (value.is_object()) {
            for (const auto& [key, member] : value.items()) flatten(member, front + key);
        } else if (value.is_array() && name.empty()) {
            for (std::size_t i = 0; i < value.size(); ++i) flatten(value[i], std::to_string(i + 1));
        } else if (!value.is_array()) {
            cells_.emplace_back(column_of(name), cell_of(value));
        }
    }

    std::size_t column_of(const std::string& name) {
        const auto [at, added] = places_.emplace(name, headings_.size());
        if (added) headings_.push_back(name);
        return at->second;
    }

    using Cells = std::vector<std::pair<std::size_t, std::string>>;  ///< column and value of the cells that a row has

    std::vector<std::string> headings_;
    std::unordered_map<std::string, std::size_t> places_;
    Cells cells_;
    std::vector<Cells> rows_;
};

bool holds_rows(const Json& value) {
    return value.is_array() && value.size() > 1 &&
           std::ranges::all_of(value, [](const Json& row) { return row.is_object() || row.is_array(); });
}

bool is_column(const Json& value) {
    return value.is_array() && value.size() > 1 &&
           std::ranges::none_of(value, [](const Json& cell) { return cell.is_structured(); });
}

std::optional<ShapedText> from_rows(const Json& rows) {
    JsonTable table;
    const bool of_lists = std::ranges::all_of(rows, [](const Json& row) {
        return row.is_array() && !row.empty() &&
               std::ranges::all_of(row, [](const Json& inner) { return inner.is_object(); });
    });
    for (const Json& row : rows) {
        if (!of_lists) {
            table.add(row);
            continue;
        }
        for (const Json& inner : row) table.add(inner);
    }
    if (table.columns() < 2 || table.rows() < 2) return std::nullopt;
    if (table.columns() > kMaxColumns) {
        ShapedText out;
        out.fault = too_many_columns(table.columns());
        return out;
    }
    return table.table(of_lists || rows.front().is_object());
}

std::optional<ShapedText> from_columns(const Json& object, int depth = 0) {
    std::vector<std::pair<std::string, const Json*>> columns;
    for (const auto& [name, value] : object.items())
        if (is_column(value)) columns.emplace_back(name, &value);
    constexpr int kDeepest = 3;
    for (const auto& [name, value] : object.items()) {
        if (columns.size() > 1 || depth == kDeepest || !value.is_object()) continue;
        if (auto held = from_columns(value, depth + 1)) return held;
    }
    if (columns.size() < 2) return std::nullopt;
    const std::size_t length = columns.front().second->size();
    if (std::ranges::any_of(columns, [&](const auto& column) { return column.second->size() != length; }))
        return std::nullopt;
    ShapedText out;
    std::vector<std::string> cells(columns.size());
    std::vector<std::string_view> line;
    for (const auto& [name, values] : columns) line.emplace_back(name);
    add_line(out, line, 1);
    for (std::size_t i = 0; i < length && out.fault.empty(); ++i) {
        for (std::size_t k = 0; k < columns.size(); ++k) cells[k] = cell_of((*columns[k].second)[i]);
        add_line(out, {cells.begin(), cells.end()}, static_cast<int>(i) + 1);
    }
    return out;
}

}  // namespace

std::optional<ShapedText> json_rows(std::string_view text) {
    text = trimmed(text);
    if (text.size() < 2) return std::nullopt;
    const bool array = text.front() == '[' && text.back() == ']', object = text.front() == '{' && text.back() == '}';
    if (!array && !object) return std::nullopt;
    // "[14:05:06] temp=20" is a line of a log.
    const std::string_view inner = trimmed(text.substr(1));
    if (array && inner.front() != '{' && inner.front() != '[') return std::nullopt;
    auto parsed = parse(text);
    const Json* value = std::get_if<Json>(&parsed);
    if (value == nullptr) return std::nullopt;
    std::optional<ShapedText> out;
    if (holds_rows(*value)) out = from_rows(*value);
    if (value->is_array() && value->size() == 1 && holds_rows(value->front())) out = from_rows(value->front());
    if (value->is_object()) {
        const auto held = std::ranges::count_if(*value, holds_rows);
        if (held == 1) out = from_rows(*std::ranges::find_if(*value, holds_rows));
        if (held == 0) out = from_columns(*value);
    }
    if (out) out->notes.emplace_back("The file is JSON; line numbers are those of its samples, from 1.");
    return out;
}

}  // namespace tunewright::api
