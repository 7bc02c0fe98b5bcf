#include "api/batch/known_loops.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "api/batch/todays_columns.h"
#include "api/csv/cell.h"
#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"
#include "api/csv/table.h"
#include "api/csv/text.h"
#include "api/csv/time_stamp.h"
#include "api/describe/body.h"
#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxKnownLoops = 100'000;

/// Members of a loop, and of its ranges, by their headings.
using FactColumn = std::pair<std::string_view, std::string_view>;
constexpr std::array<FactColumn, 7> kFactColumns = {{{"kind", "/kind"},
                                                     {"averaging", "/averaging"},
                                                     {"pv low", "/range/pv/0"},
                                                     {"pv high", "/range/pv/1"},
                                                     {"op low", "/range/op/0"},
                                                     {"op high", "/range/op/1"},
                                                     {"weight", "/weight"}}};

struct KnownColumn {
    std::string name;                          ///< as written
    std::string pointer;                       ///< in the loop
    std::optional<TodaysColumn> setting = {};  ///< of today's controller
    std::optional<double> factor = {};         ///< of a time with a unit, to the unit of the answer
};

bool is_tag(std::string_view name) { return name == "tag" || name == "loop" || name == "name"; }

std::optional<bool> yes_or_no(std::string_view cell) {
    double number = 0;
    if (read_cell_number(cell, number) && (number == 0 || number == 1)) return number == 1;
    const std::string word = lower_case(cell);
    if (word == "yes" || word == "no") return word == "yes";
    const auto level = switch_word(cell);
    return level ? std::optional(*level != 0) : std::nullopt;
}

class TableOfLoops {
public:
    explicit TableOfLoops(const std::string& time_unit) : time_unit_(time_unit) {}

    void read(std::string_view text) {
        find_signs(text);
        std::size_t at = 0;
        for (line_ = 1; const auto line = next_line(text, at); ++line_) {
            if (trimmed(*line).empty() || (columns_.empty() && named_separator(*line))) continue;
            unquoted_.clear();
            split_line(*line, separator_, cells_, unquoted_);
            columns_.empty() ? read_headings() : read_row();
            if (columns_.empty() || loops_.size() > kMaxKnownLoops) break;
        }
        if (loops_.size() > kMaxKnownLoops)
            fault("The table has more than " + std::to_string(kMaxKnownLoops) + " loops.");
        if (loops_.empty() && faults_.empty())
            fault(
                "The table has no loop. It needs a line of headings, such as tag,kind,pv_low,pv_high, and one for "
                "each loop.");
    }

    std::vector<FieldError> take_faults() { return std::move(faults_); }
    std::deque<KnownLoop> take_loops() { return std::move(loops_); }

private:
    void fault(std::string detail) { faults_.push_back({"/loops", std::move(detail)}); }
    void fault(const std::string& column, const std::string& detail) {
        fault("Line " + std::to_string(line_) + ", " + column + ": " + detail);
    }

    /// Finds the separator by the first line, and the decimal sign by all cells.
    void find_signs(std::string_view text) {
        std::size_t at = 0;
        DecimalSignFinder finder;
        bool first = true;
        while (const auto line = next_line(text, at)) {
            if (trimmed(*line).empty()) continue;
            if (first) separator_ = named_separator(*line).value_or(most_frequent(*line));
            if (std::exchange(first, false)) continue;
            unquoted_.clear();
            split_line(*line, separator_, cells_, unquoted_);
            for (std::size_t i = 0; i < cells_.size(); ++i) finder.look_at(cells_[i], i);
        }
        sign_ = finder.found();
    }

    static char most_frequent(std::string_view line) {
        constexpr std::string_view kSeparators = ",;\t|";
        return *std::ranges::max_element(kSeparators, {}, [&](char c) { return std::ranges::count(line, c); });
    }

    void read_headings() {
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            if (cells_[i].empty()) {
                columns_.push_back({});
                continue;
            }
            const Heading heading = split_heading(cells_[i]);
            std::string name = heading.name;
            std::ranges::replace(name, '_', ' ');
            const auto known = std::ranges::find(kFactColumns, std::string_view(name), &FactColumn::first);
            if (known != kFactColumns.end())
                columns_.push_back({heading.text, std::string(known->second)});
            else if (is_tag(name))
                columns_.push_back({heading.text, ""}), tag_ = i;
            else
                add_setting(heading, i);
        }
        if (!tag_) fault("The table has no column tag. Its headings are " + listed(quoted_cells(), "and") + ".");
        if (!faults_.empty()) columns_.clear();
    }

    std::vector<std::string> quoted_cells() const {
        std::vector<std::string> out;
        for (const std::string_view cell : cells_) out.push_back(in_quotes(std::string(cell)));
        return out;
    }

    void add_setting(const Heading& heading, std::size_t cell) {
        auto setting = todays_column(heading);
        if (!setting || setting->member.empty() || setting->is_of_controller())
            return fault(heading.text,
                         "this column is not known. Columns are tag, kind, averaging, pv_low, pv_high, op_low, "
                         "op_high, weight, form, Kp, Ti, Td, Tf, b, c, Ki and Kd.");
        setting->cell = cell;
        KnownColumn column{heading.text, "/controller/" + setting->member};
        if (setting->is_time() && !heading.unit.empty()) {
            const auto own = seconds_per(heading.unit), answer = seconds_per(time_unit_);
            if (!own || !answer)
                return fault(heading.text, in_quotes(heading.unit) + " is not a unit of time that can be converted.");
            column.factor = *own / *answer;
        }
        column.setting = std::move(setting);
        columns_.push_back(std::move(column));
    }

    std::string_view cell(std::size_t i) const {
        return i < cells_.size() && !is_missing(cells_[i]) ? cells_[i] : std::string_view();
    }

    void read_row() {
        const std::size_t before = faults_.size();
        const auto beyond = cells_.begin() + static_cast<std::ptrdiff_t>(std::min(cells_.size(), columns_.size()));
        if (std::any_of(beyond, cells_.end(), [](std::string_view one) { return !one.empty(); }))
            return fault("Line " + std::to_string(line_) + " has more cells than headings.");
        KnownLoop loop;
        loop.tag = std::string(cell(*tag_));
        if (loop.tag.empty()) return fault("Line " + std::to_string(line_) + " has no tag.");
        std::vector<TodaysColumn> settings;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (columns_[i].setting)
                settings.push_back(*columns_[i].setting);
            else if (!columns_[i].pointer.empty() && !cell(i).empty())
                put(columns_[i], cell(i), loop.members);
        }
        add_controller(settings, loop.members);
        if (faults_.size() == before) check(loop);
        if (faults_.size() == before) loops_.push_back(std::move(loop));
    }

    void put(const KnownColumn& column, std::string_view text, Json& members) {
        const Json::json_pointer where(column.pointer);
        double number = 0;
        if (column.pointer == "/kind") {
            members[where] = lower_case(text);
        } else if (column.pointer == "/averaging") {
            const auto answer = yes_or_no(text);
            if (!answer) return fault(column.name, in_quotes(std::string(text)) + " must be true or false.");
            members[where] = *answer;
        } else if (read_cell_number(text, number, sign_, unit_suffix(text))) {
            if (column.pointer.starts_with("/range/") && !members.contains(where.parent_pointer()))
                members[where.parent_pointer()] = Json::array({nullptr, nullptr});
            const auto whole = static_cast<std::int64_t>(std::clamp(number, -1e15, 1e15));
            // As people write it, in the request and in faults: 100, not 100.0.
            members[where] = number == static_cast<double>(whole) ? Json(whole) : Json(number);
        } else {
            fault(column.name, in_quotes(std::string(text)) + " is not a number.");
        }
    }

    void add_controller(const std::vector<TodaysColumn>& settings, Json& members) {
        std::vector<FieldError> wrong;
        Json controller = todays_settings(settings, cells_, sign_, "", wrong);
        for (FieldError& error : wrong)
            faults_.push_back({"/loops", "Line " + std::to_string(line_) + ", " + error.detail});
        if (controller.is_null() || !wrong.empty()) return;
        for (const KnownColumn& column : columns_) {
            const Json::json_pointer where("/" + (column.setting ? column.setting->member : ""));
            if (column.factor && controller.contains(where))
                controller[where] = controller[where].get<double>() * *column.factor;
        }
        members["controller"] = std::move(controller);
    }

    /// Reads the members as the contract does, and names each fault by its column.
    void check(KnownLoop& loop) {
        for (const std::string end : {"pv", "op"}) {
            const Json range = loop.members.value(Json::json_pointer("/range/" + end), Json::array());
            if (std::ranges::find(range, Json()) == range.end()) continue;
            return fault(end + "_low and " + end + "_high", "a range needs both ends.");
        }
        Reader reader;
        loop_facts_contract().read(loop.members, loop.facts, reader);
        const auto problem = reader.problem();
        if (!problem) return;
        for (const FieldError& error : problem->errors) fault(columns_at(error.pointer), error.detail);
    }

    /// The names of the columns at or below a pointer into the loop.
    std::string columns_at(const std::string& pointer) const {
        std::vector<std::string> names;
        for (const KnownColumn& column : columns_)
            if (!column.pointer.empty() && (column.pointer + "/").starts_with(pointer + "/"))
                names.push_back(column.name);
        return names.empty() ? pointer.substr(1) : listed(names, "and");
    }

    const std::string& time_unit_;
    char separator_ = ',';
    DecimalSign sign_ = DecimalSign::either;
    int line_ = 0;
    std::optional<std::size_t> tag_;
    std::vector<KnownColumn> columns_;
    std::vector<std::string_view> cells_;
    std::deque<std::string> unquoted_;
    std::deque<KnownLoop> loops_;
    std::vector<FieldError> faults_;
};

Problem refused_table(std::vector<FieldError> faults) {
    Problem problem{422, "invalid-request", "The table of loops is not valid", faults.front().detail, {}, {}};
    if (faults.size() > 1) problem.detail += " " + std::to_string(faults.size() - 1) + " more in errors.";
    problem.errors = std::move(faults);
    return problem;
}

}  // namespace

std::variant<KnownLoops, Problem> KnownLoops::read(std::string_view bytes, const std::string& time_unit) {
    std::string storage;
    TableOfLoops table(time_unit);
    table.read(utf8_text(bytes, storage));
    std::vector<FieldError> faults = table.take_faults();
    KnownLoops out;
    for (KnownLoop& loop : table.take_loops()) {
        const auto [place, fresh] = out.places_.try_emplace(lower_case(loop.tag), out.entries_.size());
        if (fresh)
            out.entries_.push_back({std::move(loop)});
        else
            faults.push_back({"/loops", loop.tag + " is in two lines. Remove one of them."});
    }
    if (!faults.empty()) return refused_table(std::move(faults));
    return out;
}

const KnownLoop* KnownLoops::of(const std::string& tag) {
    const auto place = places_.find(lower_case(tag));
    if (place == places_.end()) return nullptr;
    entries_[place->second].used = true;
    return &entries_[place->second].loop;
}

std::string KnownLoops::unused_note() const {
    constexpr std::size_t kMaxNamed = 5;
    std::vector<std::string> tags;
    std::size_t count = 0;
    for (const Entry& entry : entries_)
        if (!entry.used && ++count <= kMaxNamed) tags.push_back(entry.loop.tag);
    if (count == 0) return {};
    if (count > kMaxNamed) tags.push_back(std::to_string(count - kMaxNamed) + " more");
    return listed(tags, "and") + (count == 1 ? " is" : " are") + " in the table of loops, but no record has " +
           (count == 1 ? "this tag." : "these tags.");
}

}  // namespace tunewright::api
