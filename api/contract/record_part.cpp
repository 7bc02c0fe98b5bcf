#include <algorithm>
#include <cmath>
#include <limits>

#include "api/contract/record.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

// `rows` ascend. A column that the record does not have stays empty.
template <class T>
void keep(const std::vector<std::size_t>& rows, std::vector<T>& column) {
    if (column.empty()) return;
    for (std::size_t k = 0; k < rows.size(); ++k) column[k] = column[rows[k]];
    column.resize(rows.size());
}

// The row whose value of `column` holds at the time `from`; empty where none before it has a number.
std::optional<std::size_t> row_held(const std::vector<double>& t, const std::vector<double>& column, double from) {
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < column.size(); ++i)
        if (t[i] < from && !std::isnan(column[i]) && (!last || t[i] >= t[*last])) last = i;
    return last;
}

// u and the disturbances hold where a cell is blank, also from rows that are left out.
void hold_from_before(double from, std::size_t first, Record& record) {
    std::vector<std::vector<double>*> columns = {&record.u};
    for (FurtherInput& input : record.d) columns.push_back(&input.values);
    for (std::vector<double>* column : columns) {
        if (!std::isnan((*column)[first])) continue;
        if (const auto row = row_held(record.t, *column, from)) (*column)[first] = (*column)[*row];
    }
}

// u_step and u0 speak of the time before the file's first sample, which `from` leaves out. True if that is reported.
bool left_out_by_from(const GivenRecord& given, const ReadRecord& read, double from, Reader& reader) {
    const auto held = row_held(read.record.t, read.record.u, from);
    if (!held) return false;
    const std::string rows = "the rows before " + tunewright::text(from) + ", which from leaves out";
    if (given.u_step) {
        reader.fault_at(
            "from", "u steps at the first row by u_step, among " + rows + ". Leave from out, or give u as a column.");
        return true;
    }
    const double u = read.record.u[*held];
    if (!given.u0 || *given.u0 == u) return false;
    reader.fault_at("u0", "u0 is " + tunewright::text(*given.u0) + " and u is " + tunewright::text(u) +
                              " at the end of " + rows + ". Leave u0 out.");
    return true;
}

}  // namespace

void choose_part(const GivenRecord& given, ReadRecord& read, Reader& reader) {
    if (!given.from && !given.to) return;
    constexpr double kUnlimited = std::numeric_limits<double>::infinity();
    const double from = given.from.value_or(-kUnlimited), to = given.to.value_or(kUnlimited);
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < read.record.t.size(); ++i) {
        if (const double t = read.record.t[i]; t >= from && t <= to) rows.push_back(i);
    }
    if (rows.size() < 2) {
        const auto [first, last] = std::minmax_element(read.record.t.begin(), read.record.t.end());
        const std::string extent = read.record.t.empty() ? ""
                                                         : " It runs from " + tunewright::text(*first) + " to " +
                                                               tunewright::text(*last) + ".";
        reader.fault_at(given.from ? "from" : "to", "fewer than 2 samples of the record lie in the part that is used." +
                                                        extent + " Choose a wider part.");
        return;
    }
    if (left_out_by_from(given, read, from, reader)) return;
    Record& record = read.record;
    const auto earliest = std::ranges::min_element(rows, {}, [&](std::size_t row) { return record.t[row]; });
    hold_from_before(from, *earliest, record);
    const std::size_t all = record.t.size();
    keep(rows, record.t);
    keep(rows, record.u);
    keep(rows, record.y);
    keep(rows, record.r);
    for (FurtherInput& input : record.d) keep(rows, input.values);
    keep(rows, record.line);
    read.notes.push_back("Of " + std::to_string(all) + " samples, the " + std::to_string(rows.size()) + " from " +
                         tunewright::text(record.t.front()) + " to " + tunewright::text(record.t.back()) +
                         " were used, as asked.");
}

}  // namespace tunewright::api
