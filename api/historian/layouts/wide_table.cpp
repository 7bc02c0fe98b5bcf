#include "api/historian/layouts/wide_table.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <set>
#include <utility>

#include "api/csv/columns/heading.h"
#include "api/historian/layouts/tag_clock.h"
#include "api/historian/values/joined_tags.h"
#include "api/historian/values/mode_track.h"

namespace tunewright::api {
namespace {

/// A column of times, with the time of the present row.
struct ClockColumn {
    TagClock clock;
    std::size_t cell;
    std::optional<std::size_t> day_clock;  ///< column of the time of day, if it is apart from the date
    std::optional<double> now = {};
};

struct ValueColumn {
    std::size_t cell, clock;  ///< clock: index in WideTable::clocks_
    std::optional<std::size_t> quality;
    ValueCells cells;
    std::string name;
    std::deque<double> values = {};
    std::deque<double> times = {};  ///< only if the file has several clocks
};

struct ModeCells {
    std::size_t cell, clock;
    ModeTrack track;
    std::string name;
    std::deque<std::uint8_t> values = {};
    std::deque<double> times = {};
};

/// A loop with indices in WideTable::values_ and modes_.
struct WideLoop {
    LoopTags tags;
    std::optional<std::size_t> y = {}, u = {}, r = {}, mode = {};
};

template <class Value>
std::vector<Value> taken(std::deque<Value>& column) {
    std::vector<Value> out(column.begin(), column.end());
    column = {};
    return out;
}

std::string_view cell_of(const std::vector<std::string_view>& cells, std::size_t column) {
    return column < cells.size() ? cells[column] : std::string_view();
}

/// The values that are there, at their times.
TagValues present(const std::vector<double>& times, const std::vector<double>& values) {
    TagValues out;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) continue;
        out.t.push_back(times[i]);
        out.value.push_back(values[i]);
    }
    return out;
}

/// True if y and u are mostly in different lines.
bool in_different_lines(const std::vector<double>& y, const std::vector<double>& u) {
    std::size_t ys = 0, us = 0, both = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
        const bool has_y = !std::isnan(y[i]), has_u = !std::isnan(u[i]);
        ys += has_y ? 1 : 0;
        us += has_u ? 1 : 0;
        both += has_y && has_u ? 1 : 0;
    }
    return 2 * both < std::min(ys, us);
}

class WideTable : public LoopTable {
public:
    WideTable(std::vector<ClockColumn> clocks, double spacing) : clocks_(std::move(clocks)), spacing_(spacing) {}

    /// `clock_of`: the index of the clock of a column.
    template <class ClockOf>
    void add(const TableHead& head, LoopTags tags, const ClockOf& clock_of) {
        WideLoop loop{std::move(tags)};
        const auto value = [&](ColumnRole role, std::optional<std::size_t> quality) -> std::optional<std::size_t> {
            const auto column = loop.tags.at[role];
            if (!column || !loop.tags.fault.empty()) return std::nullopt;
            if (quality) qualities_.push_back(*quality);
            values_.push_back({*column, clock_of(*column), quality, head.value_cells(*column), head.name(*column)});
            return values_.size() - 1;
        };
        loop.y = value(kOutputRole, loop.tags.y_quality);
        loop.u = value(kInputRole, loop.tags.u_quality);
        loop.r = value(kReferenceRole, {});
        if (const auto column = loop.tags.at[kModeRole]; column && loop.tags.fault.empty()) {
            modes_.push_back({*column, clock_of(*column), ModeTrack(head.name(*column)), head.name(*column)});
            loop.mode = modes_.size() - 1;
        }
        loops_.push_back(std::move(loop));
    }

    void learn_quality(const TableHead& head) { quality_ = head.quality(qualities_); }

    void row(int line, const std::vector<std::string_view>& cells) override {
        bool any = clocks_.empty();
        for (ClockColumn& clock : clocks_) {
            double t = 0;
            const std::string_view day = clock.day_clock ? cell_of(cells, *clock.day_clock) : std::string_view();
            const bool read = clock.clock.read(cell_of(cells, clock.cell), day, line, file_, t);
            clock.now = read ? std::optional(t) : std::nullopt;
            any = any || read;
        }
        if (!any) return;
        const bool shared = clocks_.size() < 2;
        if (shared) times_.push_back(clocks_.empty() ? static_cast<double>(rows_) * spacing_ : *clocks_.front().now);
        ++rows_;
        numbers_ += values_.size() + 1;
        for (ValueColumn& column : values_) {
            const std::string_view cell = cell_of(cells, column.cell);
            const bool bad = column.quality && quality_.is_bad(cell_of(cells, *column.quality));
            if (!shared && (cell.empty() || !clocks_[column.clock].now)) continue;
            column.values.push_back(column.cells.read(cell, bad));
            if (!shared) column.times.push_back(*clocks_[column.clock].now), ++numbers_;
        }
        for (ModeCells& column : modes_) {
            column.track.see(cell_of(cells, column.cell));
            if (!shared && !clocks_[column.clock].now) continue;
            column.values.push_back(column.track.now());
            if (!shared) column.times.push_back(*clocks_[column.clock].now);
        }
    }

    bool next(TaggedLoop& out) override {
        if (next_ == loops_.size()) return false;
        if (next_ == 0) finish_times();
        WideLoop& loop = loops_[next_++];
        out = {};
        out.tag = loop.tags.name;
        out.epoch = file_.start.epoch;
        out.utc = file_.start.utc;
        if (!loop.tags.fault.empty()) return set_fault(out, loop.tags.fault), true;
        clocks_.size() < 2 ? take_lines(loop, out) : take_tags(loop, out);
        describe(loop, out);
        put_rows_in_order(out);
        refuse_empty(out, values_[*loop.y].name, values_[*loop.u].name);
        return true;
    }

    std::size_t numbers() const override { return numbers_; }
    std::size_t rows() const override { return rows_; }
    std::vector<std::string> notes() override {
        if (!clocks_.empty())
            for (std::string& note : clocks_.front().clock.take_notes()) notes_.push_back(std::move(note));
        if (next_ == 0) finish_times();
        return std::exchange(notes_, {});
    }

private:
    void finish_times() {
        if (!shared_times_.empty() || times_.empty()) return;
        shared_times_ = taken(times_);
        const int restarts = file_.start.epoch ? 0 : continue_restarted(shared_times_);
        if (restarts > 0)
            notes_.push_back("The times start again " + std::to_string(restarts) +
                             (restarts == 1 ? " time" : " times") + "; the rows were joined one after the other.");
    }

    TagValues tag_of(std::optional<std::size_t> column) {
        if (!column) return {};
        return {taken(values_[*column].times), taken(values_[*column].values)};
    }

    /// Each value at the time of its own clock.
    void take_tags(const WideLoop& loop, TaggedLoop& out) {
        TagModes mode;
        if (loop.mode) mode = {taken(modes_[*loop.mode].times), taken(modes_[*loop.mode].values)};
        join(tag_of(loop.y), tag_of(loop.u), tag_of(loop.r), std::move(mode), out);
    }

    static void join(TagValues y, TagValues u, TagValues r, TagModes mode, TaggedLoop& out) {
        for (TagValues* tag : {&y, &u, &r}) put_in_order(*tag);
        put_in_order(mode);
        join_tags(y, u, r, mode, out);
    }

    void take_lines(const WideLoop& loop, TaggedLoop& out) {
        const std::vector<double> y = taken(values_[*loop.y].values), u = taken(values_[*loop.u].values);
        std::vector<double> r = loop.r ? taken(values_[*loop.r].values) : std::vector<double>();
        std::vector<std::uint8_t> mode = loop.mode ? taken(modes_[*loop.mode].values) : std::vector<std::uint8_t>();
        if (in_different_lines(y, u)) {
            TagModes modes;
            if (loop.mode) modes = {shared_times_, std::move(mode)};
            return join(present(shared_times_, y), present(shared_times_, u), present(shared_times_, r),
                        std::move(modes), out);
        }
        hold(r);
        for (auto* column : {&out.t, &out.y, &out.u}) column->reserve(y.size());
        if (loop.r) out.r.reserve(y.size());
        if (loop.mode) out.mode.reserve(y.size());
        for (std::size_t i = 0; i < y.size(); ++i) {
            if (std::isnan(y[i]) && std::isnan(u[i])) continue;
            out.t.push_back(shared_times_[i]);
            out.y.push_back(y[i]);
            out.u.push_back(u[i]);
            if (loop.r) out.r.push_back(r[i]);
            if (loop.mode) out.mode.push_back(mode[i]);
        }
    }

    /// Counts and findings of the loop's columns.
    void describe(const WideLoop& loop, TaggedLoop& out) const {
        for (const auto column : {loop.y, loop.u, loop.r}) {
            if (!column) continue;
            const ValueColumn& values = values_[*column];
            if (column != loop.r) out.bad += values.cells.bad();
            if (auto note = values.cells.unread_note(values.name); !note.empty()) out.notes.push_back(std::move(note));
        }
        if (loop.mode) take_mode_words(modes_[*loop.mode].track, modes_[*loop.mode].name, out);
    }

    std::vector<ClockColumn> clocks_;
    double spacing_;  ///< of the rows of a file without times
    std::vector<std::size_t> qualities_;
    ValueQuality quality_;
    std::vector<ValueColumn> values_;
    std::vector<ModeCells> modes_;
    std::vector<WideLoop> loops_;
    FileTimes file_;
    std::deque<double> times_;          ///< of the rows, if the file has one clock
    std::vector<double> shared_times_;  ///< the same after the last row
    std::size_t rows_ = 0, numbers_ = 0, next_ = 0;
    std::vector<std::string> notes_;
};

/// Columns that hold only times, and are no part of a loop.
std::vector<std::size_t> clock_columns(const TableHead& head, const std::vector<LoopTags>& loops) {
    std::set<std::size_t> used;
    for (const LoopTags& loop : loops)
        for (const auto& column : loop.at)
            if (column) used.insert(*column);
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < head.columns.size(); ++i) {
        const ColumnProfile& held = head.columns[i];
        const bool stamps = held.stamps > 0 && held.numbers == 0 && held.texts == 0;
        const bool counts = held.numbers > 2 && held.rises && i < head.layout.headings.size() &&
                            match(split_heading(head.layout.headings[i]), kTimeRole);
        if ((stamps || counts) && !used.contains(i)) out.push_back(i);
    }
    return out;
}

/// The nearest of the `clocks` on the left of a column; the first one if none is there.
std::size_t nearest_clock(const std::vector<std::size_t>& clocks, std::size_t column) {
    const auto right = std::ranges::upper_bound(clocks, column);
    return right == clocks.begin() ? clocks.front() : *(right - 1);
}

/// The clocks that the columns of the loops use: `main`, or several.
std::vector<std::size_t> clocks_of(const TableHead& head, const std::vector<LoopTags>& loops, std::size_t main) {
    const std::vector<std::size_t> all = clock_columns(head, loops);
    std::set<std::size_t> used;
    for (const LoopTags& loop : loops)
        for (const auto& column : loop.at)
            if (column && !all.empty()) used.insert(nearest_clock(all, *column));
    if (used.size() < 2) return {main};
    return {used.begin(), used.end()};
}

std::variant<std::unique_ptr<LoopTable>, Problem> wide_table(const TableHead& head, const DetectedColumns& found,
                                                             std::vector<LoopTags> loops, const LoopsOptions& options) {
    std::vector<std::size_t> clocks;
    std::vector<ClockColumn> columns;
    if (found.at[kTimeRole]) {
        const std::size_t main = *found.at[kTimeRole];
        auto clock = open_clock(head, main, found.clock, options);
        if (const auto* reason = std::get_if<std::string>(&clock)) return unreadable_loops(*reason);
        clocks = found.clock ? std::vector{main} : clocks_of(head, loops, main);
        for (const std::size_t column : clocks) columns.push_back({std::get<TagClock>(clock), column, found.clock});
    }
    const double spacing = found.spacing ? spacing_of(*found.spacing, csv_options(options)) : 1;
    auto table = std::make_unique<WideTable>(std::move(columns), spacing);
    const auto clock_of = [&](std::size_t column) -> std::size_t {
        if (clocks.size() < 2) return 0;
        const std::size_t nearest = nearest_clock(clocks, column);
        return static_cast<std::size_t>(std::ranges::lower_bound(clocks, nearest) - clocks.begin());
    };
    for (LoopTags& loop : loops) table->add(head, std::move(loop), clock_of);
    table->learn_quality(head);
    return table;
}

/// The choice of a column by its number from 1.
ColumnChoice number_of(std::optional<std::size_t> column) { return static_cast<int>(*column) + 1; }

}  // namespace

std::variant<std::unique_ptr<LoopTable>, Problem> open_wide_table(const TableHead& head, std::vector<LoopTags> loops,
                                                                  const LoopsOptions& options) {
    // With y and u of one loop chosen, the search for columns finds the times.
    CsvOptions csv = csv_options(options);
    csv.columns.y = number_of(loops.front().at[kOutputRole]);
    csv.columns.u = number_of(loops.front().at[kInputRole]);
    std::vector<CsvFault> faults;
    const DetectedColumns found = find_columns(head.text, head.layout, head.columns, csv, faults);
    if (!head.layout.surplus.empty() && !faults.empty()) return unreadable_loops(faults.front().message);
    if (!found.at[kTimeRole] && !found.spacing)
        return unreadable_loops("The file has no column of times. Add one, such as Time, in front of the tags.");
    return wide_table(head, found, std::move(loops), options);
}

std::variant<std::unique_ptr<LoopTable>, Problem> open_single_table(const TableHead& head,
                                                                    const LoopsOptions& options) {
    std::vector<CsvFault> faults;
    const DetectedColumns found = find_columns(head.text, head.layout, head.columns, csv_options(options), faults);
    if (!faults.empty()) {
        constexpr std::size_t kMaxListedColumns = 20;
        const std::string why = head.layout.width <= kMaxListedColumns ? " " + faults.front().message : "";
        return unreadable_loops(
            "No loop was found. Name the columns after their tags, such as FIC101.PV, FIC101.OP, FIC101.SP and "
            "FIC101.MODE." +
            why);
    }
    LoopTags loop{options.name, found.at, {}, {}};
    loop.at[kTimeRole].reset();
    return wide_table(head, found, {std::move(loop)}, options);
}

}  // namespace tunewright::api
