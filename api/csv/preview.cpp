#include "api/csv/preview.h"

#include <algorithm>
#include <cmath>

#include "api/csv/columns/columns.h"
#include "api/csv/record_notes.h"
#include "api/csv/shape/shape.h"
#include "api/csv/text.h"
#include "engine/numerics/statistics.h"

namespace tunewright::api {
namespace {

/// Minimum and maximum of stretches that double in length whenever there are too many of them.
class Thumbnail {
public:
    void add(double value) {
        if (in_stretch_ == 0) {
            if (stretches_.size() == kMaxStretches) merge();
            stretches_.push_back({value, value});
        }
        auto& [low, high] = stretches_.back();
        low = std::min(low, value);
        high = std::max(high, value);
        in_stretch_ = (in_stretch_ + 1) % length_;
    }

    std::vector<double> numbers() const {
        std::vector<double> out;
        for (const auto& [low, high] : stretches_) {
            out.push_back(low);
            if (length_ > 1) out.push_back(high);
        }
        return out;
    }

private:
    static constexpr std::size_t kMaxStretches = 120;

    void merge() {
        for (std::size_t i = 0; i < kMaxStretches / 2; ++i) {
            const auto &a = stretches_[2 * i], &b = stretches_[2 * i + 1];
            stretches_[i] = {std::min(a.first, b.first), std::max(a.second, b.second)};
        }
        stretches_.resize(kMaxStretches / 2);
        length_ *= 2;
    }

    std::vector<std::pair<double, double>> stretches_;
    std::size_t length_ = 1, in_stretch_ = 0;
};

std::string separator_name(const CsvLayout& layout) {
    if (layout.pairs) return "pairs";
    if (!layout.source_lines.empty()) return "values";
    if (layout.separator == '\t') return "tab";
    return layout.separator == ' ' ? "blanks" : std::string(1, layout.separator);
}

double confidence_of(const CsvLayout& layout, std::size_t column, ColumnRole role, bool chosen) {
    constexpr double kConfidenceOfTag = 0.9, kConfidenceOfHeld = 0.7, kConfidenceOfContents = 0.5;
    if (chosen) return 1;
    const auto found =
        column < layout.headings.size() ? match(split_heading(layout.headings[column]), role) : std::nullopt;
    if (!found) return kConfidenceOfContents;
    return found->level == 1 ? 1 : found->level == 2 ? kConfidenceOfTag : kConfidenceOfHeld;
}

void guess(const DetectedColumns& found, const CsvLayout& layout, const ColumnChoices& chosen, CsvPreview& preview) {
    const std::array<bool, kRoleCount> given = {chosen.t.has_value(), chosen.u.has_value(), chosen.y.has_value(),
                                                chosen.r.has_value(), chosen.mode.has_value()};
    for (const ColumnRole role : kRoles) {
        if (!found.at[role]) continue;
        PreviewColumn& column = preview.columns[*found.at[role]];
        column.guess = role_name(role);
        column.confidence = confidence_of(layout, *found.at[role], role, given[role]);
    }
    if (found.clock) preview.columns[*found.clock].guess = "t";
}

bool passed_over(const std::vector<CsvSkip>& skipped, int line) {
    return std::any_of(skipped.begin(), skipped.end(), [&](const CsvSkip& skip) { return skip.line == line; });
}

/// Reads every row once: counts them, and profiles each column over the rows that are not skipped.
void look_through(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& held,
                  CsvPreview& preview) {
    std::vector<Thumbnail> thumbnails(preview.columns.size());
    CsvLines lines(text, layout);
    CsvLine line;
    while (lines.next(line)) {
        ++preview.rows;
        if (passed_over(preview.skipped, line.number)) continue;
        for (std::size_t i = 0; i < std::min(preview.columns.size(), line.cells.size()); ++i) {
            PreviewColumn& column = preview.columns[i];
            const std::string_view cell = line.cells[i];
            if (column.first.empty() && !is_missing(cell)) column.first = std::string(cell.substr(0, 40));
            double value = 0;
            if (!read_cell_number(cell, value, layout.sign, held[i].suffix)) continue;
            column.min = std::min(column.min.value_or(value), value);
            column.max = std::max(column.max.value_or(value), value);
            thumbnails[i].add(value);
        }
    }
    for (std::size_t i = 0; i < preview.columns.size(); ++i) preview.columns[i].thumbnail = thumbnails[i].numbers();
}

PreviewTime times_of(const CsvRecord& record, const CsvOptions& options) {
    constexpr double kMinGapInSpacings = 5;  // in median spacings, as in the record's quality
    PreviewTime time;
    time.unit = options.time_unit;
    time.assumed = !record.time_unit_known;
    const auto [first, last] = std::minmax_element(record.t.begin(), record.t.end());
    time.from = *first;
    time.to = *last;
    std::vector<double> spacings;
    for (std::size_t i = 1; i < record.t.size(); ++i) {
        const double spacing = std::abs(record.t[i] - record.t[i - 1]);
        if (spacing > 0)
            spacings.push_back(spacing);
        else
            ++time.duplicates;
    }
    if (spacings.empty()) return time;
    time.dt = median(spacings);
    time.gaps = static_cast<int>(std::count_if(spacings.begin(), spacings.end(),
                                               [&](double spacing) { return spacing > kMinGapInSpacings * time.dt; }));
    return time;
}

}  // namespace

CsvPreview preview_csv(std::string_view bytes, const CsvOptions& options) {
    CsvPreview preview;
    const CsvSource source(bytes, options.columns);
    const std::string_view text = source.text();
    preview.encoding = encoding_of(bytes);
    const CsvLayout& layout = source.layout();
    preview.separator = separator_name(layout);
    preview.decimal = layout.sign == DecimalSign::comma ? "," : ".";
    std::vector<ColumnProfile> held;
    if (layout.data_line > 0) {
        held = profiles(text, layout);
        preview.columns.resize(held.size());
        for (std::size_t i = 0; i < held.size(); ++i) {
            if (i < layout.headings.size()) preview.columns[i].heading = layout.headings[i];
            preview.columns[i].unit = unit_of(layout, held[i], i);
        }
        std::vector<CsvFault> faults;
        guess(find_columns(text, layout, held, options, faults), layout, options.columns, preview);
    }
    auto read = read_csv_record(source, options);
    if (auto* record = std::get_if<CsvRecord>(&read)) preview.skipped = std::move(record->skipped);
    if (layout.data_line > 0) look_through(text, layout, held, preview);
    if (auto* faults = std::get_if<std::vector<CsvFault>>(&read)) {
        preview.problems = std::move(*faults);
        return preview;
    }
    auto& record = std::get<CsvRecord>(read);
    preview.time = times_of(record, options);
    preview.skipped_lines = record.dropped;
    preview.runs = std::move(record.runs);
    if (!preview.runs.empty()) preview.run = record.run;
    preview.notes = std::move(record.notes);
    for (std::string* warning : {&record.unread, &record.unread_column, &record.unknown_mode})
        if (!warning->empty()) preview.notes.push_back(std::move(*warning));
    return preview;
}

}  // namespace tunewright::api
