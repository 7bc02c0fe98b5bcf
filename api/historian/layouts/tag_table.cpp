#include "api/historian/layouts/tag_table.h"

#include <deque>
#include <utility>

#include "api/csv/columns/heading.h"
#include "api/historian/layouts/tag_clock.h"
#include "api/historian/tags/loop_tags.h"
#include "api/historian/values/mode_track.h"

namespace tunewright::api {
namespace {

class TagTable : public LoopTable {
public:
    TagTable(const TableHead& head, TagColumns columns, TagClock clock)
        : columns_(std::move(columns)), clock_(std::move(clock)), cells_(head.value_cells(columns_.value)) {
        if (split_tag(columns_.tag).role == kModeRole) {
            // Codes have their meaning in the heading, if the file has one for them.
            const std::string heading = head.name(columns_.value);
            mode_.emplace(match(split_heading(heading), kModeRole) ? heading : columns_.tag);
        }
        if (columns_.quality) quality_ = head.quality({*columns_.quality});
    }

    void row(int line, const std::vector<std::string_view>& cells) override {
        const auto cell = [&](std::optional<std::size_t> column) {
            return column && *column < cells.size() ? cells[*column] : std::string_view();
        };
        double t = 0;
        if (!clock_.read(cell(columns_.time), cell(columns_.clock), line, file_, t)) return;
        ++rows_;
        const bool bad = columns_.quality && quality_.is_bad(cell(columns_.quality));
        const std::string_view value = cell(columns_.value);
        if (mode_) {
            mode_->see(value);
            modes_.push_back(mode_->now());
        } else {
            if (value.empty() && !bad) return;
            values_.push_back(cells_.read(value, bad));
        }
        times_.push_back(t);
    }

    bool next(TaggedLoop& out) override {
        if (std::exchange(taken_, true)) return false;
        out = {};
        out.tag = columns_.tag;
        out.only_tag = true;
        out.epoch = file_.start.epoch;
        out.utc = file_.start.utc;
        out.t.assign(times_.begin(), times_.end());
        out.y.assign(values_.begin(), values_.end());
        out.mode.assign(modes_.begin(), modes_.end());
        out.bad = cells_.bad();
        if (auto note = cells_.unread_note(columns_.tag); !note.empty()) out.notes.push_back(std::move(note));
        if (mode_) take_mode_words(*mode_, columns_.tag, out);
        return true;
    }

    std::size_t numbers() const override { return 2 * times_.size(); }
    std::size_t rows() const override { return rows_; }
    std::vector<std::string> notes() override { return clock_.take_notes(); }

private:
    TagColumns columns_;
    TagClock clock_;
    ValueCells cells_;
    std::optional<ModeTrack> mode_;
    ValueQuality quality_;
    FileTimes file_;
    std::deque<double> times_, values_;
    std::deque<std::uint8_t> modes_;
    std::size_t rows_ = 0;
    bool taken_ = false;
};

bool names_part(const TagName& name) { return name.role && !name.quality && !name.key.empty(); }

}  // namespace

std::optional<TagColumns> find_tag_columns(const TableHead& head, const LoopsOptions& options) {
    std::optional<std::size_t> time, clock, value, quality;
    for (std::size_t i = 0; i < head.columns.size(); ++i) {
        const ColumnProfile& held = head.columns[i];
        const bool headed = i < head.layout.headings.size();
        const Heading heading = split_heading(headed ? head.layout.headings[i] : "");
        const bool stamps = held.stamps > 0 && held.numbers == 0 && held.texts == 0;
        if (!time && (stamps || (headed && held.rises && match(heading, kTimeRole))))
            time = i;
        else if (time && !clock && stamps && held.clocks > 0 && head.columns[*time].dates > 0)
            clock = i;
        else if (headed && split_tag(head.layout.headings[i]).quality)
            quality = i;
        else if (value)
            return std::nullopt;
        else
            value = i;
    }
    if (!time || !value) return std::nullopt;
    TagColumns out{options.name, *time, *value, clock, quality};
    const bool named = *value < head.layout.headings.size() && names_part(split_tag(head.layout.headings[*value]));
    if (named) out.tag = head.layout.headings[*value];
    if (!named && !(options.named_by_file && names_part(split_tag(out.tag)))) return std::nullopt;
    return out;
}

std::variant<std::unique_ptr<LoopTable>, Problem> open_tag_table(const TableHead& head, const TagColumns& columns,
                                                                 const LoopsOptions& options) {
    auto clock = open_clock(head, columns.time, columns.clock, options);
    if (const auto* reason = std::get_if<std::string>(&clock)) return unreadable_loops(*reason);
    return std::make_unique<TagTable>(head, columns, std::get<TagClock>(std::move(clock)));
}

}  // namespace tunewright::api
