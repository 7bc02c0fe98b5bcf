#include "api/csv/shape/long_columns.h"

#include <cstdio>
#include <functional>
#include <set>

#include "api/csv/columns/column_profile.h"
#include "api/csv/columns/heading.h"
#include "api/csv/columns/heading_words.h"

namespace tunewright::api {
namespace {

constexpr std::string_view kTagNames[] = {
    "tagname",       "tag",          "varname",    "pointname",     "name",          "tag name",    "tag_name",
    "variable",      "series",       "_field",     "entity_id",     "metric",        "signal",      "point",
    "sensor",        "channel",      "item",       "tagid",         "point name",    "tagindex",    "topic",
    "key",           "measurement",  "attribute",  "parameter",     "variable name", "sensor_id",   "quantity",
    "variable_name", "kanal",        "messstelle", "metric_name",   "_measurement",  "signal name", "data point",
    "datapoint",     "statistic_id", "entity",     "friendly_name", "nodeid",        "node_id",     "object"};
constexpr std::string_view kValueNames[] = {"value",   "varvalue", "wert",  "vvalue",   "_value",    "state", "val",
                                            "reading", "payload",  "valor", "messwert", "datavalue", "data",  "mean"};
constexpr std::string_view kFirstTime[] = {"_time", "last_changed", "last_updated"};
constexpr std::string_view kMilliseconds[] = {"millitm", "millisecond", "milliseconds", "msec"};

class LongFinder {
public:
    LongFinder(std::string_view text, const CsvLayout& layout, bool one_tag)
        : text_(text), layout_(layout), one_tag_(one_tag), profiles_(profiles(text, layout)) {
        for (std::size_t i = 0; i < profiles_.size(); ++i)
            headings_.push_back(split_heading(i < layout.headings.size() ? layout.headings[i] : ""));
    }

    std::optional<LongColumns> find() {
        LongColumns out;
        std::optional<std::size_t> value;
        for (std::size_t i = 0; i < profiles_.size(); ++i) {
            if (is_one_of(headings_[i].name, kTagNames) && is_tag(i)) out.tags.push_back(i);
            if (!value && is_one_of(headings_[i].name, kValueNames)) value = i;
        }
        if (layout_.headings.empty()) return by_contents();
        if (out.tags.empty() || !value) return std::nullopt;
        std::erase(out.tags, *value);
        out.value = *value;
        if (out.tags.empty() || !find_time(out)) return std::nullopt;
        return out;
    }

private:
    bool times(std::size_t i) const {
        const ColumnProfile& p = profiles_[i];
        return p.stamps > 0 && p.stamps >= p.numbers + p.texts;
    }

    /// True for words that change, or for numbers of tags.
    bool is_tag(std::size_t i) const {
        const ColumnProfile& p = profiles_[i];
        const bool number = headings_[i].name == "tagindex" || headings_[i].name == "tagid";
        const bool words = p.text_changes > 0 || (one_tag_ && p.texts > 0);
        return (words && p.texts >= p.numbers + p.stamps) || (number && p.changes > 0);
    }

    bool find_time(LongColumns& out) const {
        std::optional<std::size_t> time;
        for (const std::string_view name : kFirstTime)
            for (std::size_t i = 0; i < profiles_.size(); ++i)
                if (!time && headings_[i].name == name && (times(i) || profiles_[i].numbers > 0)) time = i;
        for (std::size_t i = 0; i < profiles_.size() && !time; ++i)
            if (times(i) && match(headings_[i], kTimeRole)) time = i;
        for (std::size_t i = 0; i < profiles_.size() && !time; ++i)
            if (times(i)) time = i;
        for (std::size_t i = 0; i < profiles_.size() && !time; ++i)
            if (profiles_[i].numbers > 0 && i != out.value && match(headings_[i], kTimeRole)) time = i;
        if (!time) return false;
        out.time = *time;
        out.time_heading = headings_[*time].text;
        const ColumnProfile& p = profiles_[*time];
        const bool dates = p.stamps > 0 && p.dates == p.stamps, clocks = p.stamps > 0 && p.clocks == p.stamps;
        for (std::size_t i = 0; i < profiles_.size(); ++i) {
            const ColumnProfile& q = profiles_[i];
            if (i != out.time && times(i) && dates && q.clocks == q.stamps) out.clock = i;
            if (i != out.time && times(i) && clocks && q.dates == q.stamps) {
                out.clock = out.time;
                out.time = i;
                break;
            }
            if (is_one_of(headings_[i].name, kMilliseconds) && q.numbers > 0) out.millis = i;
        }
        if (out.clock) out.time_heading = "time";
        return true;
    }

    /// The columns of a file without headings: a stamp, a word that repeats, a value.
    std::optional<LongColumns> by_contents() const {
        constexpr std::size_t kColumns = 3;
        constexpr int kMinRowsPerName = 4;
        if (layout_.pairs || profiles_.size() != kColumns) return std::nullopt;
        LongColumns out;
        std::optional<std::size_t> time, value;
        for (std::size_t i = 0; i < kColumns; ++i) {
            const ColumnProfile& p = profiles_[i];
            if (times(i))
                time = i;
            else if (p.texts > 0 && p.numbers == 0 && p.stamps == 0 && p.text_changes > 0)
                out.tags.push_back(i);
            else if (p.numbers > 0 && p.numbers >= p.texts)
                value = i;
        }
        if (!time || !value || out.tags.size() != 1) return std::nullopt;
        std::set<std::string, std::less<>> words;
        CsvLines lines(text_, layout_);
        CsvLine line;
        int rows = 0;
        while (rows < kProfiledLines && lines.next(line)) {
            if (line.cells.size() != kColumns) continue;
            ++rows;
            words.emplace(line.cells[out.tags.front()]);
        }
        if (words.size() < 2 || static_cast<int>(words.size()) * kMinRowsPerName > rows) return std::nullopt;
        out.time = *time;
        out.value = *value;
        out.time_heading = "time";
        return out;
    }

    std::string_view text_;
    const CsvLayout& layout_;
    bool one_tag_;
    std::vector<ColumnProfile> profiles_;
    std::vector<Heading> headings_;
};

/// The columns among `tags` whose words differ between lines.
std::vector<std::size_t> varying(std::string_view text, const CsvLayout& layout, std::vector<std::size_t> tags) {
    if (tags.size() < 2) return tags;
    CsvLines lines(text, layout);
    CsvLine line;
    // Two columns that always change together name the same tag.
    std::vector<std::set<std::string>> seen(tags.size());
    for (int n = 0; n < kProfiledLines && lines.next(line); ++n)
        for (std::size_t k = 0; k < tags.size(); ++k)
            if (tags[k] < line.cells.size()) seen[k].emplace(line.cells[tags[k]]);
    std::size_t max = 0;
    for (std::size_t k = 1; k < tags.size(); ++k)
        if (seen[k].size() > seen[max].size()) max = k;
    std::set<std::string> joint;
    CsvLines again(text, layout);
    for (int n = 0; n < kProfiledLines && again.next(line); ++n) {
        std::string key;
        for (const std::size_t tag : tags)
            if (tag < line.cells.size()) key += std::string(line.cells[tag]) + "\n";
        joint.insert(std::move(key));
    }
    if (joint.size() == seen[max].size()) return {tags[max]};
    return tags;
}

}  // namespace

std::optional<LongColumns> find_long_columns(std::string_view text, const CsvLayout& layout, bool one_tag) {
    constexpr std::size_t kMinWidth = 3;
    if (layout.data_line == 0 || layout.width < kMinWidth) return std::nullopt;
    auto found = LongFinder(text, layout, one_tag).find();
    if (!found) return std::nullopt;
    if (!one_tag) found->tags = varying(text, layout, std::move(found->tags));
    found->numbers_tags = !layout.headings.empty() &&
                          is_one_of(split_heading(layout.headings[found->tags.front()]).name, {"tagindex", "tagid"});
    return found;
}

std::string long_tag(const std::vector<std::string_view>& cells, const LongColumns& columns) {
    std::string tag;
    for (const std::size_t i : columns.tags) {
        if (i >= cells.size()) continue;
        if (!tag.empty()) tag += ".";
        tag += cells[i];
    }
    if (columns.numbers_tags && !tag.empty()) tag.insert(0, "Tag ");
    return tag;
}

std::string long_time(const std::vector<std::string_view>& cells, const LongColumns& at) {
    const auto cell = [&](std::size_t i) { return i < cells.size() ? std::string(cells[i]) : std::string(); };
    std::string time = cell(at.time);
    if (at.clock) time += " " + cell(*at.clock);
    double millis = 0;
    if (at.millis && time.find('.') == time.npos && read_cell_number(cell(*at.millis), millis) && millis >= 0 &&
        millis < 1000) {
        char digits[8];
        std::snprintf(digits, sizeof digits, ".%03d", static_cast<int>(millis));
        time += digits;
    }
    return time;
}

bool is_tag_heading(std::string_view name) { return is_one_of(name, kTagNames); }

bool is_value_heading(std::string_view name) { return is_one_of(name, kValueNames); }

}  // namespace tunewright::api
