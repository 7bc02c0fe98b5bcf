#include "api/batch/loops.h"

#include <algorithm>
#include <utility>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"
#include "api/csv/table.h"
#include "api/describe/suggest.h"
#include "api/json/json.h"
#include "api/json/writer.h"
#include "api/service.h"
#include "engine/request/plan.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kLookedLines = 200, kLookedBytes = 64 * 1024;
constexpr std::size_t kMissing = static_cast<std::size_t>(-1);
constexpr std::string_view kImplement = "implement/";  ///< of parameters of the call
constexpr std::array<const char*, 4> kTitles = {"name", "K", "T", "L"};

/// Finds a column by its heading in lower case, without its unit.
std::optional<std::size_t> column_named(const std::string& name) {
    static const std::array<std::vector<std::string>, 4> kNames = {{
        {"name", "tag", "loop", "loop name", "tag name", "tagname"},
        {"k", "gain", "process gain", "static gain"},
        {"t", "tau", "lag", "time constant"},
        {"l", "theta", "dead time", "deadtime", "delay"},
    }};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (std::find(kNames[i].begin(), kNames[i].end(), name) != kNames[i].end()) return i;
    }
    return std::nullopt;
}

Problem not_valid(std::string title, std::vector<FieldError> errors) {
    Problem problem{422, "invalid-request", std::move(title), errors.front().detail, std::move(errors), {}};
    if (problem.errors.size() > 1)
        problem.detail = std::to_string(problem.errors.size()) +
                         " values are not valid. The first: " + problem.errors.front().detail;
    return problem;
}

Problem refused(std::string detail) { return not_valid("The CSV of loops cannot be read", {{"", std::move(detail)}}); }

/// Sets the value at a path: "filter/Tf" opens an object.
void place(Json& object, std::string_view path, Json value) {
    const std::size_t slash = path.find('/');
    Json& member = object[std::string(path.substr(0, slash))];
    if (slash == path.npos) {
        member = std::move(value);
    } else {
        if (!member.is_object()) member = Json::object();
        place(member, path.substr(slash + 1), std::move(value));
    }
}

/// Numbers, true, false and arrays such as [1, 2] are read as JSON; everything else is a text.
Json value_of(const std::string& text) {
    auto parsed = parse(text);
    if (auto* value = std::get_if<Json>(&parsed)) return std::move(*value);
    return text;
}

bool is_blank(const std::vector<std::string_view>& cells) {
    return std::all_of(cells.begin(), cells.end(), [](std::string_view cell) { return cell.empty(); });
}

}  // namespace

Loops::Loops(const LoopOptions& options) {
    constexpr std::ptrdiff_t kDeepest = 4;
    for (std::size_t i = 0; i < options.size(); ++i) {
        const auto& [name, value] = options[i];
        const auto same = [&, &key = name](const auto& other) { return other.first == key; };
        if (std::find_if(options.begin(), options.begin() + static_cast<std::ptrdiff_t>(i), same) !=
                options.begin() + static_cast<std::ptrdiff_t>(i) ||
            std::count(name.begin(), name.end(), '/') > kDeepest) {
            names_given_twice_.push_back(name);
        } else if (name == "timeout_s") {
            timeout_ = value_of(value);
        } else if (name.starts_with(kImplement)) {
            place(implement_, std::string_view(name).substr(kImplement.size()), value_of(value));
        } else {
            place(tune_, name, name == "method" ? Json(value) : value_of(value));
        }
    }
    Writer tail;
    tail.begin_object();
    if (!tune_.empty()) {
        if (!tune_.contains("method")) tune_["method"] = MethodRequest{}.method;
        tail.key("tune").raw(Json::array({tune_}).dump());
    }
    if (!timeout_.is_null()) tail.key("timeout_s").raw(timeout_.dump());
    tail.end_object();
    tail_ = tail.take().substr(1);
}

std::optional<Problem> Loops::check_options() const {
    constexpr const char* kTitle = "The parameters for all loops are not valid";
    if (!names_given_twice_.empty()) {
        return not_valid(
            kTitle, {{"/" + pointer_segment(names_given_twice_.front()),
                      in_quotes(names_given_twice_.front()) + " is given twice, or nests too deep. A CSV of loops has "
                                                              "one method; batches of JSON may have several."}});
    }
    const auto tried = prepare_entry(request("", {1, 1, 1}, implement_, nullptr));
    const auto* problem = std::get_if<Problem>(&tried);
    if (problem == nullptr) return std::nullopt;
    Problem named = *problem;
    named.title = kTitle;
    constexpr std::string_view kPrefix = "/tune/0";
    for (FieldError& error : named.errors) {
        if (error.pointer.starts_with(kPrefix)) error.pointer.erase(0, kPrefix.size());
    }
    return named;
}

std::string Loops::request(std::string_view name, const std::array<double, 3>& plant, const Json& implement,
                           const Json& today) const {
    Writer out;
    out.begin_object();
    if (!name.empty()) out.key("name").text(name);
    if (!time_unit_.empty()) {
        out.key("units").begin_object();
        out.key("time").text(time_unit_);
        out.end_object();
    }
    out.key("plant").begin_object();
    out.key("type").text("fopdt");
    for (std::size_t i = 0; i < plant.size(); ++i) out.key(kTitles[i + kGain]).number(plant[i]);
    out.end_object();
    if (!implement.empty()) out.key("implement").raw(implement.dump());
    if (!today.is_null()) out.key("baseline").raw(today.dump());
    std::string text = out.take();
    if (tail_.size() > 1) text += ',';
    return text += tail_;
}

std::optional<Problem> Loops::feed(long number, std::string_view line, std::vector<RawEntry>& entries) {
    if (!open_.empty()) return gather(number, line, entries), std::nullopt;
    const std::string_view content = trimmed(line);
    if (content.empty() || is_comment(content)) return std::nullopt;
    if (!headed_) return read_headings(number, line);
    if (stays_open(line))
        gather(number, line, entries);
    else
        take({number, std::string(line)}, entries);
    return std::nullopt;
}

/// True if a cell that begins with quotes continues in the next line. Quotes within a cell are inches.
bool Loops::stays_open(std::string_view text) const {
    if (separator_ == ' ') return false;
    bool quoted = false, begins = true;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool quotes = text[i] == '"';
        if (quoted && quotes && i + 1 < text.size() && text[i + 1] == '"')
            ++i;
        else if (quoted || text[i] == separator_)
            begins = !quoted, quoted = quoted && !quotes;
        else if (text[i] != ' ')
            quoted = begins && quotes, begins = false;
    }
    return quoted;
}

void Loops::gather(long number, std::string_view line, std::vector<RawEntry>& entries) {
    constexpr std::size_t kMaxLines = 20;
    open_.push_back({number, std::string(line)});
    Held row = open_.front();
    for (std::size_t i = 1; i < open_.size(); ++i) row.text.append("\n").append(open_[i].text);
    if (!stays_open(row.text)) {
        open_.clear();
        take(std::move(row), entries);
    } else if (open_.size() >= kMaxLines) {
        give_up(entries);
    }
}

/// Refuses the first of the lines as a row of its own, which cannot be read, and reads the others again.
void Loops::give_up(std::vector<RawEntry>& entries) {
    std::vector<Held> lines = std::exchange(open_, {});
    lines.front().unclosed = true;
    take(std::move(lines.front()), entries);
    for (std::size_t i = 1; i < lines.size(); ++i) feed(lines[i].number, lines[i].text, entries);
}

void Loops::take(Held row, std::vector<RawEntry>& entries) {
    if (sign_known_) return read_row(row, entries);
    held_bytes_ += row.text.size();
    held_.push_back(std::move(row));
    if (held_.size() >= kLookedLines || held_bytes_ >= kLookedBytes) release(entries);
}

void Loops::finish(std::vector<RawEntry>& entries) {
    while (!open_.empty()) give_up(entries);
    release(entries);
}

void Loops::release(std::vector<RawEntry>& entries) {
    if (!sign_known_) find_sign();
    for (const Held& held : held_) read_row(held, entries);
    held_.clear();
}

std::optional<Problem> Loops::read_headings(long number, std::string_view line) {
    if (const auto named = separator_given_ ? std::nullopt : named_separator(line)) {
        separator_ = *named;
        separator_given_ = true;
        return std::nullopt;
    }
    // The separator with which the most known columns are found.
    std::size_t max = 0;
    char best = separator_given_ ? separator_ : ',';
    for (const char separator : {';', '\t', ',', '|', ' '}) {
        if (separator_given_) break;
        separator_ = separator;
        split(line);
        const auto known =
            static_cast<std::size_t>(std::count_if(cells_.begin(), cells_.end(), [](std::string_view heading) {
                const Heading parts = split_heading(heading);
                return column_named(parts.name) || todays_column(parts);
            }));
        if (known <= max) continue;
        max = known;
        best = separator;
    }
    separator_ = best;
    split(line);
    return find_columns(number, cells_);
}

std::optional<Problem> Loops::find_columns(long number, const std::vector<std::string_view>& headings) {
    const std::string where = "Line " + std::to_string(number) + " must name the columns, such as name,K,T,L: ";
    at_.fill(kMissing);
    todays_.clear();
    const auto known = [](std::string_view heading) { return column_named(split_heading(heading).name).has_value(); };
    if (std::ranges::none_of(headings, known))
        return refused(
            "Line " + std::to_string(number) +
            " has no heading of a column of loops. Put name,K,T,L into the first line, above the loops. For records of "
            "loops in operation add ?kind=check.");
    width_ = headings.size();
    while (width_ > 0 && headings[width_ - 1].empty()) --width_;
    std::array<std::string, kColumns> units;
    for (std::size_t i = 0; i < width_; ++i) {
        const Heading heading = split_heading(headings[i]);
        const auto column = column_named(heading.name);
        if (auto today = column ? std::nullopt : todays_column(heading)) {
            if (std::ranges::find(todays_, today->name, &TodaysColumn::name) != todays_.end())
                return refused(where + "two columns say " + in_quotes(today->name) + ". Remove one.");
            today->cell = i;
            todays_.push_back(*std::move(today));
            continue;
        }
        if (!column)
            return refused(
                where + in_quotes(headings[i]) +
                " is not a column of loops. The columns are name, K, T and L; of the controller product, sample time, "
                "y "
                "low, y high, u low and u high; of today's settings Kp, Ti, Td, Tf, b, c and form, or a product's own "
                "as \"today GAIN\". Remove that column: method and limits are set once for all loops.");
        if (at_[*column] != kMissing) return refused(where + "two columns say " + kTitles[*column] + ". Remove one.");
        at_[*column] = i;
        units[*column] = heading.unit;
    }
    std::vector<std::string> missing;
    for (const Column column : {kGain, kLag, kDelay}) {
        if (at_[column] == kMissing) missing.emplace_back(kTitles[column]);
    }
    if (!missing.empty())
        return refused(
            where + listed(missing, "and") + (missing.size() == 1 ? " is" : " are") +
            " missing. Each loop is K e^(-L s)/(T s + 1), with K the gain, T the time constant, L the dead time.");
    if (auto problem = find_unit(where, units)) return problem;
    const auto any = [&](const auto& fits) { return std::ranges::any_of(todays_, fits); };
    own_settings_ = any([](const TodaysColumn& one) { return one.member.empty(); });
    const bool ranges = any([](const TodaysColumn& one) { return one.member.find("_span/") != std::string::npos; });
    const bool named = any([](const TodaysColumn& one) { return one.member == "product"; });
    if ((own_settings_ || ranges) && !named && !implement_.contains("product"))
        return refused(where + (own_settings_ ? "columns of a product's own settings" : "columns of ranges") +
                       " need to know the product. Add a column product, with an id such as emerson_deltav_standard.");
    headed_ = true;
    return std::nullopt;
}

/// T, L and today's times have one unit; a product's settings have its own.
std::optional<Problem> Loops::find_unit(const std::string& where, const std::array<std::string, kColumns>& units) {
    std::vector<std::pair<std::string, std::string>> times = {{"T", units[kLag]}, {"L", units[kDelay]}};
    const bool product = std::ranges::any_of(todays_, [](const TodaysColumn& one) { return one.member == "product"; });
    for (const TodaysColumn& one : todays_)
        if ((one.is_time() && !product) || one.member == "sample_time") times.emplace_back(one.name, one.unit);
    std::string first;
    for (const auto& [name, unit] : times) {
        if (unit.empty()) continue;
        if (time_unit_.empty()) time_unit_ = unit, first = name;
        if (unit != time_unit_)
            return refused(where + first + " is in " + in_quotes(time_unit_) + " and " + name + " in " +
                           in_quotes(unit) + "; all times must be in the same unit.");
    }
    constexpr std::size_t kMaxUnitLength = 40;
    if (time_unit_.size() > kMaxUnitLength) return refused(where + "the unit of T is longer than 40 characters.");
    return std::nullopt;
}

void Loops::find_sign() {
    DecimalSignFinder finder;
    for (const Held& held : held_) {
        split(held.text);
        for (const Column column : {kGain, kLag, kDelay}) finder.look_at(cell(column), column);
        for (const TodaysColumn& one : todays_)
            if (one.cell < cells_.size()) finder.look_at(cells_[one.cell], kColumns + one.cell);
    }
    sign_ = finder.found();
    sign_known_ = true;
}

void Loops::split(std::string_view line) {
    unquoted_.clear();
    cells_.clear();
    split_line(line, separator_, cells_, unquoted_);
}

std::string_view Loops::cell(Column column) const {
    return at_[column] < cells_.size() ? cells_[at_[column]] : std::string_view();
}

double Loops::read_number(std::string_view cell, const char* name, std::vector<FieldError>& faults) const {
    double value = 0;
    if (read_cell_number(cell, value, sign_, unit_suffix(cell))) return value;
    faults.push_back({std::string("/plant/") + name,
                      is_missing(cell) ? std::string(name) + " is missing; every loop needs K, T and L."
                                       : std::string(name) + " is " + in_quotes(cell) + "; it must be a number."});
    return 0;
}

void Loops::read_row(const Held& row, std::vector<RawEntry>& entries) {
    constexpr const char* kTitle = "The line is not a loop";
    split(row.text);
    if (is_blank(cells_)) return;
    RawEntry entry{row.number, {}, {}, {}};
    std::string name(cell(kName));
    std::ranges::replace(name, '\n', ' ');
    std::size_t filled = cells_.size();
    while (filled > 0 && cells_[filled - 1].empty()) --filled;
    if (row.unclosed) {
        entry.fault =
            not_valid(kTitle, {{"",
                                "A cell begins with a quotation mark that is not closed within 20 lines. Write "
                                "\"...\" around the cell, and \"\" for a mark inside, or leave it out."}});
    } else if (filled > width_) {
        entry.fault = not_valid(
            kTitle, {{"", "It has " + std::to_string(filled) + " cells, the headings are " + std::to_string(width_) +
                              ". Numbers with a decimal comma need ; or tab as separator, or quotes."}});
    } else {
        std::vector<FieldError> faults;
        std::array<double, 3> plant{};
        for (const Column column : {kGain, kLag, kDelay})
            plant[column - kGain] = read_number(cell(column), kTitles[column], faults);
        // The line's own controller comes before that of all loops, in whose place today's settings are typed only if
        // they have its names.
        const Json own = own_controller(todays_, cells_, sign_, faults);
        Json implement = implement_;
        implement.update(own);
        const std::string product = (own_settings_ ? implement : own).value("product", "");
        const Json today = todays_settings(todays_, cells_, sign_, product, faults);
        if (faults.empty())
            entry.text = request(name, plant, implement, today);
        else
            entry.fault = not_valid(kTitle, std::move(faults));
    }
    if (entry.fault) entry.name = std::move(name);
    entries.push_back(std::move(entry));
}

}  // namespace tunewright::api
