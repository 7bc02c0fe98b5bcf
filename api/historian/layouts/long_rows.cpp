#include "api/historian/layouts/long_rows.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading_words.h"
#include "api/csv/shape/long_columns.h"
#include "api/historian/layouts/tag_clock.h"
#include "api/historian/tags/tag_index.h"
#include "api/historian/values/mode_track.h"

namespace tunewright::api {
namespace {

/// Rows of one loop.
struct LoopStore {
    TagClock clock;
    ValueCells y, u, r;
    ModeTrack mode;
    std::deque<double> times = {}, ys = {}, us = {}, rs = {};
    std::deque<std::uint8_t> modes = {};
};

template <class Value>
std::vector<Value> released(std::deque<Value>& column) {
    std::vector<Value> out(column.begin(), column.end());
    column = {};
    return out;
}

class LongRows : public LoopTable {
public:
    LongRows(const TableHead& head, LoopRowColumns columns, TagClock clock, std::size_t time,
             std::optional<std::size_t> day_clock)
        : columns_(std::move(columns)), time_(time), day_clock_(day_clock) {
        const auto cells = [&](ColumnRole role) {
            const auto column = columns_.parts.at[role];
            names_[role] = column ? head.name(*column) : "";
            return column ? head.value_cells(*column) : ValueCells(head.layout.sign, "", false);
        };
        const auto mode = columns_.parts.at[kModeRole];
        fresh_.emplace(LoopStore{std::move(clock), cells(kOutputRole), cells(kInputRole), cells(kReferenceRole),
                                 ModeTrack(mode ? head.name(*mode) : "")});
        names_[kModeRole] = mode ? head.name(*mode) : "";
        std::vector<std::size_t> qualities;
        for (const auto& column : {columns_.parts.y_quality, columns_.parts.u_quality})
            if (column) qualities.push_back(*column);
        quality_ = head.quality(qualities);
    }

    void row(int line, const std::vector<std::string_view>& cells) override {
        const std::string_view tag = cell(cells, columns_.tag);
        if (tag.empty() || !fault_.empty()) return;
        const auto number = index_.find_or_add(tag);
        if (!number) {
            fault_ = "The file has more than " + std::to_string(kMaxLoopTags) + " loops. Send it in parts.";
            return;
        }
        if (*number == stores_.size()) stores_.push_back(std::make_unique<LoopStore>(*fresh_));
        LoopStore& loop = *stores_[*number];
        double t = 0;
        if (!loop.clock.read(cell(cells, time_), cell(cells, day_clock_), line, file_, t)) return;
        ++rows_;
        const LoopTags& parts = columns_.parts;
        loop.times.push_back(t);
        loop.ys.push_back(loop.y.read(cell(cells, parts.at[kOutputRole]), is_bad(cells, parts.y_quality)));
        loop.us.push_back(loop.u.read(cell(cells, parts.at[kInputRole]), is_bad(cells, parts.u_quality)));
        numbers_ += 3;
        if (parts.at[kReferenceRole])
            loop.rs.push_back(loop.r.read(cell(cells, parts.at[kReferenceRole]), false)), ++numbers_;
        if (!parts.at[kModeRole]) return;
        loop.mode.see(cell(cells, parts.at[kModeRole]));
        loop.modes.push_back(loop.mode.now());
    }

    bool next(TaggedLoop& out) override {
        if (next_ == stores_.size()) return false;
        out = {};
        out.tag = index_.tags()[next_];
        LoopStore& loop = *stores_[next_++];
        out.epoch = file_.start.epoch;
        out.utc = file_.start.utc;
        out.t = released(loop.times);
        out.y = released(loop.ys);
        out.u = released(loop.us);
        out.r = released(loop.rs);
        out.mode = released(loop.modes);
        describe(loop, out);
        put_rows_in_order(out);
        hold(out.r);
        refuse_empty(out, names_[kOutputRole] + " of " + out.tag, names_[kInputRole] + " of " + out.tag);
        return true;
    }

    std::size_t numbers() const override { return numbers_; }
    std::size_t rows() const override { return rows_; }
    std::string fault() const override { return fault_; }
    std::vector<std::string> notes() override { return fresh_->clock.take_notes(); }

private:
    static std::string_view cell(const std::vector<std::string_view>& cells, std::optional<std::size_t> column) {
        return column && *column < cells.size() ? cells[*column] : std::string_view();
    }

    bool is_bad(const std::vector<std::string_view>& cells, std::optional<std::size_t> quality) {
        return quality && quality_.is_bad(cell(cells, quality));
    }

    void describe(const LoopStore& loop, TaggedLoop& out) const {
        out.bad = loop.y.bad() + loop.u.bad();
        for (const auto& [cells, role] :
             {std::pair{&loop.y, kOutputRole}, {&loop.u, kInputRole}, {&loop.r, kReferenceRole}})
            if (auto note = cells->unread_note(names_[role]); !note.empty()) out.notes.push_back(std::move(note));
        if (columns_.parts.at[kModeRole]) take_mode_words(loop.mode, names_[kModeRole], out);
    }

    LoopRowColumns columns_;
    std::size_t time_;
    std::optional<std::size_t> day_clock_;
    std::optional<LoopStore> fresh_;  ///< before the first row; each loop has a copy
    std::array<std::string, kRoleCount> names_;
    ValueQuality quality_;
    TagIndex index_;
    std::vector<std::unique_ptr<LoopStore>> stores_;
    FileTimes file_;
    std::size_t rows_ = 0, numbers_ = 0, next_ = 0;
    std::string fault_;
};

}  // namespace

std::optional<LoopRowColumns> find_loop_rows(const TableHead& head) {
    static constexpr std::string_view kLoopNames[] = {"loop",       "loop name", "loop tag",
                                                      "controller", "regler",    "boucle"};
    std::vector<std::string> parts = head.layout.headings;
    LoopRowColumns out;
    bool found = false;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string name = split_heading(parts[i]).name;
        const ColumnProfile& held = head.columns[i];
        const bool loop = is_one_of(name, kLoopNames);
        if (found || !(loop || is_tag_heading(name)) || !(held.texts > 0 || (loop && held.numbers > 0))) continue;
        found = true;
        out.tag = i;
        parts[i].clear();
    }
    if (!found) return std::nullopt;
    GroupedTags groups = group_tags(parts);
    if (groups.loops.size() != 1 || !groups.loops.front().name.empty()) return std::nullopt;
    out.parts = std::move(groups.loops.front());
    return out;
}

std::variant<std::unique_ptr<LoopTable>, Problem> open_long_rows(const TableHead& head, const LoopRowColumns& columns,
                                                                 const LoopsOptions& options) {
    if (!columns.parts.fault.empty()) return unreadable_loops(columns.parts.fault);
    CsvOptions csv = csv_options(options);
    csv.columns.y = static_cast<int>(*columns.parts.at[kOutputRole]) + 1;
    csv.columns.u = static_cast<int>(*columns.parts.at[kInputRole]) + 1;
    std::vector<CsvFault> faults;
    const DetectedColumns found = find_columns(head.text, head.layout, head.columns, csv, faults);
    const auto time = found.at[kTimeRole];
    if (!time) return unreadable_loops("The file has no column of times. Add one, such as Time.");
    auto clock = open_clock(head, *time, found.clock, options);
    if (const auto* reason = std::get_if<std::string>(&clock)) return unreadable_loops(*reason);
    return std::make_unique<LongRows>(head, columns, std::get<TagClock>(std::move(clock)), *time, found.clock);
}

}  // namespace tunewright::api
