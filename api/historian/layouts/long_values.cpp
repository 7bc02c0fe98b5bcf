#include "api/historian/layouts/long_values.h"

#include <deque>
#include <utility>

#include "api/historian/layouts/tag_clock.h"
#include "api/historian/tags/loop_tags.h"
#include "api/historian/tags/tag_index.h"
#include "api/historian/values/joined_tags.h"
#include "api/historian/values/mode_track.h"

namespace tunewright::api {
namespace {

/// Values of one tag; none for a tag that is no part of a loop.
struct TagStore {
    TagClock clock;
    ValueCells cells;
    std::optional<ModeTrack> mode;
    std::deque<double> times = {}, values = {};
    std::deque<std::uint8_t> modes = {};
};

class LongValues : public LoopTable {
public:
    LongValues(const TableHead& head, LongColumns columns, TagClock clock)
        : columns_(std::move(columns)), clock_(std::move(clock)), sign_(head.layout.sign) {
        for (std::size_t i = 0; i < head.layout.headings.size(); ++i)
            if (i != columns_.value && i != columns_.time && split_tag(head.layout.headings[i]).quality)
                quality_at_ = i;
        if (quality_at_) quality_ = head.quality({*quality_at_});
    }

    void row(int line, const std::vector<std::string_view>& cells) override {
        if (!fault_.empty() || columns_.value >= cells.size()) return;
        TagStore* tag = store_of(cells);
        if (tag == nullptr) return;
        double t = 0;
        if (!read_time(cells, line, *tag, t)) return;
        ++rows_;
        const std::string_view cell = cells[columns_.value];
        if (tag->mode) {
            tag->mode->see(cell);
            tag->modes.push_back(tag->mode->now());
        } else {
            const bool bad = quality_at_ && *quality_at_ < cells.size() && quality_.is_bad(cells[*quality_at_]);
            if (cell.empty() && !bad) return;
            tag->values.push_back(tag->cells.read(cell, bad));
        }
        tag->times.push_back(t);
        numbers_ += 2;
    }

    bool next(TaggedLoop& out) override {
        if (!grouped_) groups_ = group_tags(index_.tags());
        grouped_ = true;
        if (next_ == groups_.loops.size()) return false;
        const LoopTags& loop = groups_.loops[next_++];
        out = {};
        out.tag = loop.name;
        out.epoch = file_.start.epoch;
        out.utc = file_.start.utc;
        if (!loop.fault.empty()) return set_fault(out, loop.fault), true;
        join(loop, out);
        describe(loop, out);
        if (!out.fault) refuse_empty(out, tag_name(loop, kOutputRole), tag_name(loop, kInputRole));
        return true;
    }

    std::size_t numbers() const override { return numbers_; }
    std::size_t rows() const override { return rows_; }
    std::string fault() const override { return fault_; }

    std::vector<std::string> notes() override {
        std::vector<std::string> out = clock_.take_notes();
        if (!grouped_) groups_ = group_tags(index_.tags());
        grouped_ = true;
        if (auto note = partial_note(groups_.partial); !note.empty()) out.push_back(std::move(note));
        return out;
    }

private:
    /// Null for a tag that is not read.
    TagStore* store_of(const std::vector<std::string_view>& cells) {
        std::optional<std::size_t> number;
        if (columns_.tags.size() == 1 && !columns_.numbers_tags && columns_.tags.front() < cells.size())
            number = find(cells[columns_.tags.front()]);
        else
            number = find(long_tag(cells, columns_));
        return number ? stores_[*number].get() : nullptr;
    }

    std::optional<std::size_t> find(std::string_view tag) {
        if (tag.empty()) return std::nullopt;
        const auto number = index_.find_or_add(tag);
        if (!number)
            fault_ = "The file has more than " + std::to_string(kMaxLoopTags) + " tags. Send it in parts.";
        else if (*number == stores_.size())
            stores_.push_back(new_store(tag));
        return number;
    }

    std::unique_ptr<TagStore> new_store(std::string_view tag) const {
        const TagName name = split_tag(tag);
        if (!name.role || name.quality) return nullptr;
        const bool words = name.role == kInputRole;
        auto mode = name.role == kModeRole ? std::optional(ModeTrack(tag)) : std::nullopt;
        return std::make_unique<TagStore>(TagStore{clock_, ValueCells(sign_, "", words), std::move(mode)});
    }

    bool read_time(const std::vector<std::string_view>& cells, int line, TagStore& tag, double& t) {
        if (columns_.millis) return tag.clock.read(long_time(cells, columns_), {}, line, file_, t);
        const auto cell = [&](std::size_t i) { return i < cells.size() ? cells[i] : std::string_view(); };
        return tag.clock.read(cell(columns_.time), columns_.clock ? cell(*columns_.clock) : std::string_view(), line,
                              file_, t);
    }

    TagValues values_of(const LoopTags& loop, ColumnRole role) {
        if (!loop.at[role]) return {};
        TagStore& tag = *stores_[*loop.at[role]];
        TagValues out{{tag.times.begin(), tag.times.end()}, {tag.values.begin(), tag.values.end()}};
        tag.times = {};
        tag.values = {};
        put_in_order(out);
        return out;
    }

    void join(const LoopTags& loop, TaggedLoop& out) {
        TagModes mode;
        if (loop.at[kModeRole]) {
            TagStore& tag = *stores_[*loop.at[kModeRole]];
            mode = {{tag.times.begin(), tag.times.end()}, {tag.modes.begin(), tag.modes.end()}};
            tag.times = {};
            tag.modes = {};
            put_in_order(mode);
        }
        const TagValues y = values_of(loop, kOutputRole), u = values_of(loop, kInputRole);
        if (auto apart = apart_sentence(y, tag_name(loop, kOutputRole), u, tag_name(loop, kInputRole)); !apart.empty())
            return set_fault(out, std::move(apart));
        join_tags(y, u, values_of(loop, kReferenceRole), mode, out);
    }

    void describe(const LoopTags& loop, TaggedLoop& out) const {
        for (const ColumnRole role : {kOutputRole, kInputRole, kReferenceRole}) {
            if (!loop.at[role]) continue;
            const ValueCells& cells = stores_[*loop.at[role]]->cells;
            if (role != kReferenceRole) out.bad += cells.bad();
            if (auto note = cells.unread_note(tag_name(loop, role)); !note.empty())
                out.notes.push_back(std::move(note));
        }
        if (loop.at[kModeRole]) take_mode_words(*stores_[*loop.at[kModeRole]]->mode, tag_name(loop, kModeRole), out);
    }

    const std::string& tag_name(const LoopTags& loop, ColumnRole role) const { return index_.tags()[*loop.at[role]]; }

    LongColumns columns_;
    TagClock clock_;  ///< before the first time; each tag has a copy
    DecimalSign sign_;
    std::optional<std::size_t> quality_at_;
    ValueQuality quality_;
    TagIndex index_;
    std::vector<std::unique_ptr<TagStore>> stores_;
    FileTimes file_;
    std::size_t rows_ = 0, numbers_ = 0, next_ = 0;
    std::string fault_;
    GroupedTags groups_;
    bool grouped_ = false;
};

}  // namespace

std::variant<std::unique_ptr<LoopTable>, Problem> open_long_values(const TableHead& head, const LongColumns& columns,
                                                                   const LoopsOptions& options) {
    auto clock = open_clock(head, columns.time, columns.millis ? std::nullopt : columns.clock, options);
    if (const auto* reason = std::get_if<std::string>(&clock)) return unreadable_loops(*reason);
    return std::make_unique<LongValues>(head, columns, std::get<TagClock>(std::move(clock)));
}

}  // namespace tunewright::api
