#include "api/report/terminal/terminal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "api/contract/structure/structure_name.h"
#include "api/json/json.h"
#include "api/json/utf8.h"
#include "api/report/check_words.h"
#include "api/report/figures.h"
#include "api/report/plot.h"
#include "api/report/sections.h"
#include "api/report/structure/structure_words.h"
#include "api/report/terminal/columns.h"
#include "api/report/terminal/entry_rows.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr const char* kNoValue = "-";

std::string number(const Json& value) { return value.is_number() ? tunewright::text(value.get<double>()) : kNoValue; }
std::string words(const Json& value) { return value.is_string() ? value.get<std::string>() : ""; }

Json parsed_or_null(std::string_view text) {
    Json value = Json::parse(text, nullptr, false);
    return value.is_discarded() ? Json() : value;
}

std::string sentences(const Json& list, const char* member) {
    std::string out;
    for (const Json& item : list) {
        const std::string sentence = item.is_object() ? words(item.value(member, Json())) : words(item);
        if (!sentence.empty()) out += "  " + sentence + "\n";
    }
    return out;
}

/// Coefficients as text: "5.93 0.695".
std::string coefficients(const Json& values) {
    std::string out;
    for (const Json& value : values) out += (out.empty() ? "" : " ") + number(value);
    return out;
}

/// The parameters with their standard errors, "K 0.6954 +- 0.0086, T1 141.4 +- 5.9"; else "num [5.93 0.695], den [..]".
std::string parameters(const Json& model) {
    const Json errors = model.value("standard_errors", Json::object());
    const Json plant = model.value("plant", Json::object());
    std::string out;
    for (const auto& [name, value] : plant.items()) {
        if (!value.is_number() && !value.is_array()) continue;
        const bool uncertain = errors.is_object() && errors.contains(name) && errors[name].is_number();
        out += (out.empty() ? "" : ", ") + name + " ";
        if (value.is_array())
            out += "[" + coefficients(value) + "]";
        else
            out += uncertain ? uncertain_text(value.get<double>(), errors[name].get<double>()) : number(value);
    }
    return out;
}

std::string model_lines(const Json& model) {
    std::string out = "Model " + words(member_at(model, "/plant/type")) + ", fit " +
                      number(model.value("fit_percent", Json())) + " %";
    const std::string values = parameters(model);
    if (!values.empty()) out += ": " + values;
    const std::string grade =
        grade_words(words(model.value("grade", Json())), words(model.value("grade_reason", Json())));
    return out + "\n" + (grade.empty() ? "" : "  " + grade + "\n") +
           sentences(model.value("warnings", Json::array()), "message");
}

std::string table_of(const EntryRows& found, const std::string& time, std::size_t max_rows) {
    std::vector<std::string> heads{"method", "controller"};
    for (const EntryFigure& figure : kEntryFigures)
        heads.push_back(std::string(figure.name) + (figure.is_time ? " (" + time + ")" : ""));
    heads.emplace_back("verdict");
    Columns columns(std::move(heads), 2);
    for (std::size_t i = 0; i < std::min(max_rows, found.rows.size()); ++i) {
        const EntryRow& row = found.rows[i];
        std::vector<std::string> cells{row.method, row.title};
        for (const Json& figure : row.figures) cells.push_back(number(figure));
        cells.push_back(row.level);
        columns.row(std::move(cells));
    }
    return columns.text();
}

/// The settings to type into the product of an entry, and what the product cannot do.
std::string typed_settings(const Json& entry) {
    const Json entered = entry.value("as_entered", Json());
    return entered.is_object() ? settings_text(entered.dump()) : "";
}

std::string text_of_result(const Json& result, const std::string& time, std::size_t max_rows) {
    std::string out;
    if (result.contains("model")) out += model_lines(result.at("model")) + "\n";
    const EntryRows found = entry_rows(result);
    out += table_of(found, time, max_rows);
    if (found.rows.size() > max_rows)
        out += std::to_string(found.rows.size() - max_rows) + " more, in the whole answer.\n";
    if (found.without_controller > 0)
        out += std::to_string(found.without_controller) +
               (found.without_controller == 1 ? " method has" : " methods have") +
               " no result on this plant; the whole answer, in JSON, has the reasons.\n";
    const std::vector<std::size_t> order = entry_order(result);
    if (order.empty()) return out;
    const Json& best = result.at("controllers").at(order[0]);
    out += "\n" + entry_title(best) + ":\n" + sentences(best.value("verdict", Json::array()), "text");
    return out + sentences(best.value("warnings", Json::array()), "message") + typed_settings(best);
}

std::string listing(std::string_view answer, const char* member,
                    std::vector<std::pair<const char*, const char*>> heads) {
    const Json value = parsed_or_null(answer);
    std::vector<std::string> names;
    for (const auto& [head, name] : heads) names.emplace_back(head);
    Columns columns(names, heads.size());
    for (const Json& item : value.value(member, Json::array())) {
        std::vector<std::string> cells;
        for (const auto& [head, name] : heads) cells.push_back(words(item.value(name, Json())));
        columns.row(std::move(cells));
    }
    return columns.text();
}

}  // namespace

std::string settings_text(std::string_view entered) try {
    const Json value = parsed_or_null(entered);
    std::string out;
    for (const auto& [name, typed] : value.at("as_typed").items()) {
        const std::string unit = words(value.value("units", Json::object()).value(name, Json()));
        out += (out.empty() ? "" : ", ") + name + " " + words(typed) + (unit.empty() ? "" : " " + unit);
    }
    out = "Settings of " + words(value.at("product")) + ": " + out + "\n";
    for (const Json& note : value.value("notes", Json::array()))
        if (note.value("deviation", false)) out += "  " + words(note.value("detail", Json())) + "\n";
    return out;
} catch (const Json::exception&) {
    return std::string(entered) + "\n";
}

std::string result_text(std::string_view result) {
    return shortened_result_text(result, std::numeric_limits<std::size_t>::max());
}

std::string shortened_result_text(std::string_view result, std::size_t max_rows) try {
    const Json value = parsed_or_null(result);
    if (value.contains("range")) return range_text(result);
    const std::string time = words(member_at(value, "/units/time"));
    return text_of_result(value, time.empty() ? "s" : time, max_rows);
} catch (const Json::exception&) {
    return std::string(result) + "\n";
}

std::string model_text(std::string_view answer) try {
    const Json value = parsed_or_null(answer);
    const Json& model = value.at("model");
    std::string out = model_lines(model);
    const std::string reason = words(model.value("choice_reason", Json()));
    if (!reason.empty()) out += "  " + reason + "\n";
    Columns columns({"candidate", "fit (%)", "parameters"}, 3);
    for (const Json& candidate : model.value("candidates", Json::array()))
        columns.row({words(member_at(candidate, "/plant/type")), number(candidate.value("fit_percent", Json())),
                     parameters(candidate)});
    return out + "\n" + columns.text();
} catch (const Json::exception&) {
    return std::string(answer) + "\n";
}

std::string score_text(std::string_view answer) try {
    const Json value = parsed_or_null(answer);
    const auto count = [&](const char* name) { return number(value.at(name)); };
    std::string out = words(value.at("name")) + ": limits hold on " + count("kept") + " of " +
                      number(Json(value.at("problems").size())) + " problems; broken on " + count("limits_broken") +
                      ", unstable on " + count("unstable") + ", no settings for " + count("no_settings") + ".\n";
    if (value.contains("median_ratio"))
        out +=
            "IAE over the proved bound: median " + count("median_ratio") + ", at most " + count("worst_ratio") + ".\n";
    if (const Json range = value.value("range", Json()); range.is_object())
        out += "All limits hold for tau from " + number(range.at("tau_low")) + " to " + number(range.at("tau_high")) +
               " (" + number(range.at("problems")) + " problems).\n";
    Columns columns({"problem", "status", "ratio", "Ms", "Mt"}, 5);
    for (const Json& one : value.at("problems"))
        columns.row({words(one.at("name")), words(one.at("status")), number(one.value("ratio", Json())),
                     number(one.value("Ms", Json())), number(one.value("Mt", Json()))});
    return out + "\n" + columns.text();
} catch (const Json::exception&) {
    return std::string(answer) + "\n";
}

std::string methods_text(std::string_view answer) {
    return listing(answer, "methods", {{"id", "id"}, {"method", "title"}});
}

std::string controllers_text(std::string_view answer) {
    return listing(answer, "controllers", {{"id", "id"}, {"maker", "maker"}, {"controller", "name"}, {"form", "form"}});
}

std::string examples_text(std::string_view answer) {
    Json all = parsed_or_null(answer);
    for (const Json& range : all.value("ranges", Json::array())) all["examples"].push_back(range);
    return listing(all.dump(), "examples", {{"id", "id"}, {"example", "title"}});
}

std::string problem_of_file(std::string_view problem, const std::string& file) {
    Json value = Json::parse(problem, nullptr, false);
    if (file.empty() || !value.is_object()) return std::string(problem);
    constexpr std::string_view kBody = "The body";
    for (const char* member : {"title", "detail"}) {
        const std::string sentence = words(value.value(member, Json()));
        if (sentence.starts_with(kBody)) value[member] = file + sentence.substr(kBody.size());
    }
    return value.dump();
}

std::string problem_text(std::string_view problem) {
    const Json value = parsed_or_null(problem);
    if (!value.is_object()) return std::string(problem) + "\n";
    std::string out = "tunewright: " + words(value.value("detail", value.value("title", Json()))) + "\n";
    const Json errors = value.value("errors", Json::array());
    if (errors.size() < 2) return out;
    for (const Json& fault : errors) {
        const std::string place = words(fault.value("pointer", Json()));
        out += "  " + (place.empty() ? "" : place + ": ") + words(fault.value("detail", Json())) + "\n";
    }
    return out;
}

namespace {

constexpr const char* kUnknownFigure = "-";

std::string shown_figure(const Json& value, int digits = 4) {
    return value.is_number() ? tunewright::text(value.get<double>(), digits) : kUnknownFigure;
}

std::string word_at(const Json& value, const char* member) {
    return value.contains(member) && value.at(member).is_string() ? value.at(member).get<std::string>() : "";
}

/// The value of a curve at the nearest of its places.
Json curve_at(const Json& places, const Json& curve, double at) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < places.size(); ++i)
        if (std::abs(places[i].get<double>() - at) < std::abs(places[nearest].get<double>() - at)) nearest = i;
    return nearest < curve.size() ? curve[nearest] : Json();
}

Json worst_of(const Json& worst, const char* quantity) {
    for (const Json& place : worst)
        if (place.at("quantity") == quantity) return place.at("value");
    return {};
}

class RangeTable {
public:
    RangeTable(const Json& range, const std::string& time) : range_(range) {
        const Json& scheduling = range.at("scheduling");
        const std::string unit = word_at(scheduling, "unit");
        const std::string head = word_at(scheduling, "name") + (unit.empty() ? "" : " (" + unit + ")");
        columns_ = Columns({"setting", head, "Kp", "Ti (" + time + ")", "Td (" + time + ")", "Ms", "Mt", "IAE/own"}, 1);
    }

    std::string text() {
        const Json &one = range_.at("one"), &schedule = range_.at("schedule"), &worst = range_.at("worst");
        if (one.is_object()) {
            const Json& pid = one.at("controller");
            whole("one", pid, worst.value("one", Json::array()));
        }
        if (schedule.is_object()) {
            for (const Json& row : schedule.at("rows")) add_row(row);
            whole("schedule", Json::object(), worst.value("schedule", Json::array()));
        }
        return columns_.text();
    }

private:
    void whole(const char* name, const Json& pid, const Json& worst) {
        columns_.row({name, "all", shown_figure(pid.value("Kp", Json())), shown_figure(pid.value("Ti", Json())),
                      shown_figure(pid.value("Td", Json())), shown_figure(worst_of(worst, "Ms")),
                      shown_figure(worst_of(worst, "Mt")), shown_figure(worst_of(worst, "relative_IAE"))});
    }

    void add_row(const Json& row) {
        const Json& curves = range_.at("curves");
        const Json curve = curves.value("schedule", Json::object());
        const double at = row.at("at").get<double>();
        const auto there = [&](const char* name) {
            return shown_figure(curve_at(curves.at("at"), curve.value(name, Json::array()), at));
        };
        columns_.row({"row", shown_figure(row.at("at"), 6), shown_figure(row.at("Kp")), shown_figure(row.at("Ti")),
                      shown_figure(row.at("Td")), there("Ms"), there("Mt"), there("relative_IAE")});
    }

    const Json& range_;
    Columns columns_{{}, 1};
};

std::string runs_of(const Json& range) {
    if (!range.contains("runs")) return "";
    Columns columns({"run", "IAE one", "IAE schedule"}, 1);
    for (const Json& run : range.at("runs")) {
        const auto area = [&](const char* which) {
            return run.contains(which) ? shown_figure(run.at(which).at("IAE")) : std::string(kUnknownFigure);
        };
        columns.row({run.at("name").get<std::string>(), area("one"), area("schedule")});
    }
    return "\n" + columns.text();
}

}  // namespace

std::string range_text(std::string_view result) try {
    const Json value = Json::parse(result);
    const Json& range = value.at("range");
    const std::string time = value.contains("units") ? word_at(value.at("units"), "time") : "";
    std::string out = RangeTable(range, time.empty() ? "s" : time).text() + runs_of(range) + "\n";
    if (range.contains("verdict")) out += word_at(range.at("verdict"), "text") + "\n";
    for (const Json& warning : range.at("warnings")) out += "  " + word_at(warning, "detail") + "\n";
    if (range.contains("why_null"))
        for (const Json& reason : range.at("why_null")) out += "  " + reason.get<std::string>() + "\n";
    return out;
} catch (const Json::exception&) {
    return std::string(result) + "\n";
}

namespace {

constexpr std::size_t kExplainedLoops = 5;  // with sentences below the table of a check
constexpr std::size_t kWidestTag = 40;

/// The member of an object; null if there is none.
Json member_of(const Json& object, const char* name) {
    return object.is_object() ? object.value(name, Json()) : Json();
}

std::string short_tag(const Json& loop) {
    const std::string tag = words(member_of(loop, "tag"));
    return letters(tag) > kWidestTag ? std::string(whole_characters(tag, kWidestTag - 3)) + "..." : tag;
}

/// The entry of the ranking about a loop; null if there is none.
Json rank_of(const Json& ranking, std::size_t loop) {
    for (const Json& rank : ranking)
        if (member_of(rank, "loop") == loop) return rank;
    return {};
}

std::string percent_text(const Json& share) {
    return share.is_number() ? std::to_string(std::lround(100 * share.get<double>())) + " %" : kUnknownFigure;
}

std::string unit_of(const Json& answer, const char* name, const char* fallback) {
    Json units = answer.value("units", Json::object());
    // The loops of a batch have their own.
    if (units.empty() && !answer.at("loops").empty()) units = member_of(answer.at("loops").front(), "units");
    const std::string unit = words(member_of(units, name));
    return unit.empty() ? fallback : unit;
}

std::string work_list(const Json& answer, const std::vector<std::size_t>& order) {
    Columns columns(
        {"", "loop", "cause", "confidence", "do first", "owner", with_unit("gain", unit_of(answer, "y", "")),
         "of the error", "period (" + unit_of(answer, "time", "s") + ")"},
        6);
    for (std::size_t place = 0; place < order.size(); ++place) {
        const Json& loop = answer.at("loops").at(order[place]);
        const Json cause = member_of(loop, "cause"), action = member_of(loop, "action");
        const Json rank = rank_of(answer.at("ranking"), order[place]);
        columns.row({std::to_string(place + 1), short_tag(loop), verdict_title(words(member_of(cause, "verdict"))),
                     words(member_of(cause, "confidence")),
                     action_title(answer, words(member_of(action, "code")), rank),
                     owner_title(words(member_of(action, "owner"))), shown_figure(member_of(rank, "gain"), 3),
                     percent_text(member_of(rank, "share")),
                     shown_figure(member_of(member_of(loop, "oscillation"), "period"), 3)});
    }
    return columns.text();
}

std::string groups_of(const Json& answer) {
    std::string out;
    for (const Json& cluster : answer.value("clusters", Json::array()))
        out += "Oscillate together: " + tags_of_loops(answer, member_of(cluster, "loops")) + "\n  " +
               words(member_of(cluster, "detail")) + "\n";
    for (const Json& pair : answer.value("cascades", Json::array()))
        out += "Cascade: " + tag_of_loop(answer, member_of(pair, "master")) + " gives " +
               tag_of_loop(answer, member_of(pair, "slave")) + " its set point.\n";
    return out.empty() ? "" : "\n" + out;
}

std::string notes_of(const Json& answer) {
    std::string out;
    for (const Json& note : answer.value("notes", Json::array())) out += "Note: " + words(note) + "\n";
    return out.empty() ? "" : "\n" + out;
}

/// The remarks on the records, by loop.
std::string remarks_of(const Json& answer, const std::vector<std::size_t>& order) {
    std::string out;
    for (const std::size_t place : order) {
        const Json& loop = answer.at("loops").at(place);
        const std::string found = sentences(member_at(loop, "/quality/remarks"), "detail");
        if (!found.empty()) out += words(member_of(loop, "tag")) + "\n" + found;
    }
    return out.empty() ? "" : "\nOn the records:\n" + out;
}

/// The strongest evidence of the first loops that need work, and what to do.
std::string reasons_of(const Json& answer, const std::vector<std::size_t>& order) {
    std::string out;
    std::size_t explained = 0, more = 0;
    for (const std::size_t place : order) {
        const Json& loop = answer.at("loops").at(place);
        const Json action = member_of(loop, "action"), evidence = member_of(member_of(loop, "cause"), "evidence");
        if (words(member_of(action, "code")) == "none") continue;
        if (++explained > kExplainedLoops) {
            ++more;
            continue;
        }
        out += "\n" + words(member_of(loop, "tag")) + "\n" + sentences(evidence, "detail");
        for (const char* part : {"/cause/why_open", "/action/detail", "/cure/detail"})
            if (const std::string sentence = words(member_at(loop, part)); !sentence.empty())
                out += "  " + sentence + "\n";
        out += sentences(member_at(loop, "/cure/valve/stops"), "detail");
    }
    if (more > 0)
        out += "\n" + std::to_string(more) + (more == 1 ? " more loop needs" : " more loops need") +
               " work; the whole answer, in JSON, has the evidence.\n";
    return out;
}

}  // namespace

std::string structure_text(std::string_view answer) try {
    const Json value = parsed_or_null(answer);
    if (structure_of(value).empty()) return std::string(answer) + "\n";
    std::string out;
    if (const auto controllers = structure_controllers(value); !controllers.empty()) {
        Columns table({"controller", "Kp", "Ti", "Td", "Tf"}, 1);
        for (const auto& [name, pointer] : controllers)
            table.row({name, number(member_at(value, (pointer + "/Kp").c_str())),
                       number(member_at(value, (pointer + "/Ti").c_str())),
                       number(member_at(value, (pointer + "/Td").c_str())),
                       number(member_at(value, (pointer + "/filter/Tf").c_str()))});
        out += table.text() + "\n";
    }
    if (const Json design = value.value("design", Json()); design.is_object())
        out += "Kc " + number(design.value("Kc", Json())) + ", Ti " + number(design.value("Ti", Json())) + "\n\n";
    Columns figures({"figure", "value"}, 1);
    for (const StructureFigure& one : structure_figures(value))
        if (const Json::json_pointer place(one.pointer); value.contains(place))
            figures.row({one.name, number(value.at(place))});
    out += figures.text() + "\n";
    const std::string label = words(member_at(value, "/units/time"));
    const StructureUnits units{label.empty() ? "s" : label, words(member_at(value, "/units/y"))};
    for (const Json& conclusion : value.value("verdict", Json::array()))
        out += conclusion_sentence(conclusion, units) + "\n";
    return out;
} catch (const Json::exception&) {
    return std::string(answer) + "\n";
}

std::string check_text(std::string_view answer) try {
    const Json value = parsed_or_null(answer);
    if (!is_of_check(value)) return std::string(answer) + "\n";
    const std::vector<std::size_t> order = work_order(value);
    std::string out = check_summary(value) + "\n\n" + work_list(value, order) + groups_of(value) +
                      reasons_of(value, order) + remarks_of(value, order) + notes_of(value);
    if (value.value("partial", false)) out += "\nThe check was stopped before all loops were checked.\n";
    return out;
} catch (const Json::exception&) {
    return std::string(answer) + "\n";
}

namespace {

constexpr int kColumns = 62, kRows = 12;  // letters inside the frame
constexpr int kAcross = 2, kDown = 4;     // dots of a letter
constexpr std::size_t kMargin = 9;        // letters left of the frame

class Dots {
public:
    void set(int x, int y) {
        if (x < 0 || y < 0 || x >= kColumns * kAcross || y >= kRows * kDown) return;
        // Dots 1 to 8 of the letter, in the order of Unicode's bits.
        constexpr int kBits[kDown][kAcross] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
        cells_[static_cast<std::size_t>((y / kDown) * kColumns + x / kAcross)] |= kBits[y % kDown][x % kAcross];
    }

    void line(double x1, double y1, double x2, double y2) {
        const int steps = 1 + static_cast<int>(std::max(std::abs(x2 - x1), std::abs(y2 - y1)));
        for (int i = 0; i <= steps; ++i) {
            const double part = static_cast<double>(i) / steps;
            set(static_cast<int>(std::lround(x1 + part * (x2 - x1))),
                static_cast<int>(std::lround(y1 + part * (y2 - y1))));
        }
    }

    std::string row(int number) const {
        std::string out;
        for (int column = 0; column < kColumns; ++column) {
            const int code = 0x2800 + cells_[static_cast<std::size_t>(number * kColumns + column)];
            out += {static_cast<char>(0xE0 | (code >> 12)), static_cast<char>(0x80 | ((code >> 6) & 0x3F)),
                    static_cast<char>(0x80 | (code & 0x3F))};
        }
        return out;
    }

private:
    std::vector<int> cells_ = std::vector<int>(static_cast<std::size_t>(kColumns * kRows), 0);
};

void draw(const Trace& trace, const Frame& frame, Dots& dots) {
    const double right = kColumns * kAcross - 1, bottom = kRows * kDown - 1;
    const auto across = [&](double x) { return (x - frame.x.first) / (frame.x.second - frame.x.first) * right; };
    const auto down = [&](double y) { return (frame.y.second - y) / (frame.y.second - frame.y.first) * bottom; };
    for (std::size_t i = 1; i < std::min(trace.x.size(), trace.y.size()); ++i) {
        const double values[] = {trace.x[i - 1], trace.y[i - 1], trace.x[i], trace.y[i]};
        if (std::all_of(std::begin(values), std::end(values), [](double v) { return std::isfinite(v); }))
            dots.line(across(values[0]), down(values[1]), across(values[2]), down(values[3]));
    }
}

std::string padded(const std::string& text) {
    return std::string(kMargin - std::min(kMargin, text.size()), ' ') + text;
}

std::string drawn_in_dots(const Plot& plot, const Frame& frame) {
    Dots dots;
    for (const Trace& trace : plot.traces) draw(trace, frame, dots);
    std::string out = std::string(kMargin + 1, ' ') + plot.title;
    if (plot.traces.size() > 1)
        for (std::size_t i = 0; i < plot.traces.size(); ++i) out += (i == 0 ? ": " : ", ") + plot.traces[i].name;
    out += "\n";
    for (int row = 0; row < kRows; ++row) {
        std::string mark;
        if (row == 0) mark = tunewright::text(frame.y.second, 3);
        if (row == kRows - 1) mark = tunewright::text(frame.y.first, 3);
        out += padded(mark) + "│" + dots.row(row) + "\n";
    }
    const std::string from = tunewright::text(frame.x.first, 3),
                      to = tunewright::text(frame.x.second, 4) + "  " + plot.x_label;
    const std::size_t room =
        static_cast<std::size_t>(kColumns) - std::min<std::size_t>(kColumns, from.size() + to.size());
    return out + std::string(kMargin, ' ') + "└" + from + std::string(room, ' ') + to + "\n";
}

std::variant<std::vector<Plot>, Problem> plots_of(const ResultSource& source, std::string_view index) try {
    auto chosen = choose_entry(source, index);
    if (auto* problem = std::get_if<Problem>(&chosen)) return std::move(*problem);
    auto& found = std::get<ChosenEntry>(chosen);
    const std::size_t number = index.empty() ? best_proposal(found) : found.index;
    const Json document = document_of(found);
    std::vector<Plot> plots = response_plots(subject_of(document, number));
    std::erase_if(plots, [](const Plot& plot) { return !frame_of(plot); });
    if (plots.empty())
        return Problem{422,
                       "no-traces",
                       "There is nothing to draw",
                       "The result has no traces: its request asked for none. Leave evaluate.points out of it.",
                       {},
                       {}};
    return plots;
} catch (const Json::exception&) {
    return not_a_result();
}

}  // namespace

std::variant<std::string, Problem> responses_text(const ResultSource& source, std::string_view index) {
    auto plots = plots_of(source, index);
    if (auto* problem = std::get_if<Problem>(&plots)) return std::move(*problem);
    std::string out;
    for (const Plot& plot : std::get<std::vector<Plot>>(plots)) out += drawn_in_dots(plot, *frame_of(plot)) + "\n";
    return out;
}

std::variant<std::string, Problem> responses_svg(const ResultSource& source, std::string_view index) {
    auto plots = plots_of(source, index);
    if (auto* problem = std::get_if<Problem>(&plots)) return std::move(*problem);
    return svg_file(std::get<std::vector<Plot>>(plots));
}

}  // namespace tunewright::api
