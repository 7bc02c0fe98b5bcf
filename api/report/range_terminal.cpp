// A range on a terminal: its settings row by row, the worst places, the verdict.
#include <algorithm>
#include <cmath>

#include "api/json/json.h"
#include "api/report/columns.h"
#include "api/report/terminal.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr const char* kUnknownFigure = "-";

std::string shown_figure(const Json& value, int digits = 4) {
    return value.is_number() ? tunewright::text(value.get<double>(), digits) : kUnknownFigure;
}

std::string word_at(const Json& value, const char* member) {
    return value.contains(member) && value.at(member).is_string() ? value.at(member).get<std::string>() : "";
}

/// The value of a curve at the place of it that lies nearest.
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

}  // namespace tunewright::api
