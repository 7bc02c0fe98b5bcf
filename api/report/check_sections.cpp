// The report of a check: one page for the plant with the work list, then one page for each loop.
#include <algorithm>
#include <tuple>
#include <utility>

#include "api/report/check_words.h"
#include "api/report/figures.h"
#include "api/report/plot.h"
#include "api/report/sections.h"

namespace tunewright::api {
namespace {

/// A sentence with an end, as an item of a list.
void add_sentence(std::vector<Html>& items, const std::string& sentence) {
    if (!sentence.empty()) items.emplace_back(sentence);
}

std::vector<Html> sentences_at(const JsonLocation& list, const char* member) {
    std::vector<Html> out;
    for (std::size_t i = 0; i < list.value().size(); ++i) add_sentence(out, text_at(list.at(i).at(member)));
    return out;
}

/// The same of a list of sentences.
std::vector<Html> sentences_in(const JsonLocation& list) {
    std::vector<Html> out;
    for (const Json& sentence : list.value())
        if (sentence.is_string()) add_sentence(out, sentence.get<std::string>());
    return out;
}

/// The place of the loop in the ranking; null if it has none.
JsonLocation rank_of(const ReportInput& s, std::size_t loop) {
    const JsonLocation ranking = s.result.at("ranking");
    for (std::size_t k = 0; k < ranking.value().size(); ++k)
        if (ranking.at(k).at("loop").value() == loop) return ranking.at(k);
    return ranking.at(ranking.value().size());
}

/// The gain with its unit; why there is none.
Html gain_of(const ReportInput& s, const JsonLocation& rank) {
    if (rank.at("gain").value().is_number()) return figure(rank.at("gain")) + Html(s.y.empty() ? "" : " " + s.y);
    if (const std::string source = tag_of_loop(s.result.value(), rank.at("after").value()); !source.empty())
        return "known when " + source + " is mended";
    const std::string why = text_at(rank.at("why_null").at("gain"));
    return why.empty() ? "–" : why;
}

Html work_list_of(const ReportInput& s) {
    std::vector<Row> rows;
    Row heads{"Place", "Loop", "Cause", "Confidence", "Do first", "Owner", "Effort", "Gain", "Share of the error"};
    bool money = false;
    for (std::size_t k = 0; k < s.result.at("ranking").value().size(); ++k)
        money = money || s.result.at("ranking").at(k).at("money").value().is_number();
    if (money) heads.emplace_back("Money an hour");
    for (const std::size_t place : work_order(s.result.value())) {
        const JsonLocation loop = s.entry.at(place), cause = loop.at("cause"), rank = rank_of(s, place);
        const ReportInput own = with_units(s, loop.at("units").value());
        rows.push_back({std::to_string(rows.size() + 1), text_at(loop.at("tag")),
                        verdict_title(text_at(cause.at("verdict"))), text_at(cause.at("confidence")),
                        action_title(s.result.value(), text_at(loop.at("action").at("code")), rank.value()),
                        owner_title(text_at(loop.at("action").at("owner"))), effort_title(rank.at("effort").value()),
                        gain_of(own, rank), figure(rank.at("share"), 2)});
        if (money) rows.back().push_back(figure(rank.at("money")));
    }
    Html out;
    if (s.result.at("partial").value() == true)
        out += element("p", element("strong", "The check was stopped before all loops were checked."));
    out += element("div", table("In the order in which to work on the loops", heads, rows), {{"class", "work-list"}});
    return section("Work list",
                   out + element("p",
                                 "Gain: by how much the mean magnitude of the error may fall when the cause "
                                 "is removed. It is an estimate."));
}

Html groups_of(const ReportInput& s) {
    const JsonLocation clusters = s.result.at("clusters");
    std::vector<Row> rows;
    for (std::size_t k = 0; k < clusters.value().size(); ++k) {
        const JsonLocation cluster = clusters.at(k);
        const std::string source = tag_of_loop(s.result.value(), cluster.at("source").value());
        rows.push_back({tags_of_loops(s.result.value(), cluster.at("loops").value()), figure(cluster.at("period")),
                        source.empty() ? "none stands out" : source, text_at(cluster.at("detail"))});
    }
    if (rows.empty()) return {};
    return section(
        "Loops that oscillate together",
        element("div", table("The likely source is named first", {"Loops", "Period (s)", "Source", "Why"}, rows),
                {{"class", "work-list"}}));
}

Html cascades_of(const ReportInput& s) {
    std::vector<Html> pairs;
    for (const Json& pair : s.result.at("cascades").value())
        pairs.emplace_back(tag_of_loop(s.result.value(), pair.value("master", Json())) + " gives " +
                           tag_of_loop(s.result.value(), pair.value("slave", Json())) + " its set point.");
    return pairs.empty() ? Html() : section("Cascades", list(pairs));
}

Html notes_of_files(const ReportInput& s) {
    const std::vector<Html> notes = sentences_in(s.result.at("notes"));
    return notes.empty() ? Html() : section("Files", list(notes));
}

/// Name and figure, for each member of `part` that has a value.
std::vector<Row> rows_of(const JsonLocation& part, const std::vector<std::pair<const char*, std::string>>& members) {
    std::vector<Row> rows;
    for (const auto& [member, name] : members)
        if (part.at(member).value().is_number()) rows.push_back({name, figure(part.at(member))});
    return rows;
}

/// A dash with its reason becomes a sentence: a title is not printed.
Html reasons_of(const JsonLocation& part, const std::vector<std::pair<const char*, std::string>>& members) {
    std::vector<Html> out;
    for (const auto& [member, name] : members)
        if (const std::string why = text_at(part.at("why_null").at(member)); !why.empty())
            out.emplace_back(name + ": none. " + why);
    return list(out);
}

Html cause_of(const JsonLocation& loop) {
    const JsonLocation cause = loop.at("cause");
    const std::string verdict = text_at(cause.at("verdict")), confidence = text_at(cause.at("confidence"));
    Html out = element("p", element("strong", verdict_title(verdict)) + Html(", " + confidence + "."));
    out += list(sentences_at(cause.at("evidence"), "detail"));
    if (const std::string why = text_at(cause.at("why_open")); !why.empty()) out += element("p", why);
    std::string others;
    for (const Json& other : cause.at("alternatives").value())
        if (other.is_string()) others += (others.empty() ? "" : ", ") + verdict_title(other.get<std::string>());
    if (!others.empty()) out += element("p", "The record does not exclude: " + others + ".");
    return section("Cause", out);
}

Html controller_row(const JsonLocation& controller, const ReportInput& s) {
    Html out;
    for (const auto& [member, unit] : {std::pair{"Kp", unit_quotient(s.u, s.y)}, {"Ti", s.time}, {"Td", s.time}})
        if (controller.at(member).value().is_number())
            out += Html((out.empty() ? "" : ", ") + std::string(member) + " ") + figure(controller.at(member), 6) +
                   Html(unit.empty() ? "" : " " + unit);
    return out;
}

Html action_of(const ReportInput& s, const JsonLocation& loop, const JsonLocation& rank) {
    const JsonLocation action = loop.at("action"), cure = loop.at("cure");
    const std::string owner = owner_title(text_at(action.at("owner")));
    Html out = element(
        "p", Html(text_at(action.at("detail"))) + Html(owner == "–" ? "" : " Whose work it is: " + owner + "."));
    if (text_at(action.at("code")) != "none") out += element("p", Html("Gain: ") + gain_of(s, rank));
    if (const std::string words = text_at(cure.at("detail")); !words.empty()) out += element("p", words);
    std::vector<Html> settings;
    for (const auto& [member, name] : {std::pair{"today", "Today's settings: "}, {"settings", "New settings: "}})
        if (cure.at(member).exists()) settings.push_back(Html(name) + controller_row(cure.at(member), s));
    for (const auto& [member, name] :
         {std::pair{"worst_Ms", "Largest Ms on the plants that fit the record: "},
          {"error_ratio", "Mean error in the recorded time, with the new settings over that of the record: "}})
        if (cure.at(member).value().is_number()) settings.push_back(Html(name) + figure(cure.at(member)));
    for (Html& item : sentences_at(cure.at("valve").at("stops"), "detail")) settings.push_back(std::move(item));
    if (const std::string test = text_at(cure.at("test").at("detail")); !test.empty()) settings.emplace_back(test);
    return section("What to do first", out + list(settings));
}

Html figures_of(const ReportInput& s, const JsonLocation& loop) {
    const JsonLocation performance = loop.at("performance"), service = loop.at("service"), quality = loop.at("quality");
    const std::vector<std::pair<const char*, std::string>> moves{{"mean_error", with_unit("Mean error", s.y)},
                                                                 {"variability", with_unit("Standard deviation", s.y)},
                                                                 {"variability_share", "Its share of the range"},
                                                                 {"idle_index", "Idle index"},
                                                                 {"following", "Following"},
                                                                 {"travel", "Travel of the output (ranges/h)"},
                                                                 {"reversals", "Reversals of the output (1/h)"}};
    const std::vector<std::pair<const char*, std::string>> shares{{"automatic", "In automatic"},
                                                                  {"manual", "In manual"},
                                                                  {"saturated_low", "Output at its lower limit"},
                                                                  {"saturated_high", "Output at its upper limit"},
                                                                  {"output_still", "Output at rest"},
                                                                  {"measurement_still", "Measurement at rest"}};
    std::vector<Row> error = rows_of(performance, moves);
    const JsonLocation harris = performance.at("harris");
    if (harris.exists()) {
        error.push_back({"Harris range, lower end", figure(harris.at("low"), 2)});
        error.push_back({"Harris range, upper end", figure(harris.at("high"), 2)});
        error.push_back({with_unit("Its shortest dead time", s.time), figure(harris.at("delays").at(0))});
        error.push_back({with_unit("Its longest dead time", s.time), figure(harris.at("delays").at(1))});
    }
    const JsonLocation cause = loop.at("cause");
    const bool plays = text_at(cause.at("verdict")) == "backlash";
    const std::vector<Row> sizes =
        rows_of(cause, {{"size", with_unit(plays ? "Width of the backlash" : "Dead band and stick", s.u)},
                        {"jump", with_unit("Jump when it breaks loose", s.u)},
                        {"period", with_unit("Period of its cycle", s.time)}});
    Html tables = table("Error and output", {"", "Value"}, error);
    if (!sizes.empty()) tables += table("Cause", {"", "Value"}, sizes);
    const JsonLocation periods = loop.at("oscillation").at("periods");
    std::vector<Row> oscillations;
    for (std::size_t k = 0; k < periods.value().size(); ++k) {
        Row row;
        for (const char* member : {"period", "period_error", "regularity", "share", "amplitude"})
            row.push_back(figure(periods.at(k).at(member), 3));
        oscillations.push_back(std::move(row));
    }
    if (!oscillations.empty())
        tables += table(
            "Oscillations of the error, the strongest first",
            {with_unit("Period", s.time), "Its error", "Regularity", "Share of variance", with_unit("Amplitude", s.y)},
            oscillations);
    tables += table("Shares of the time, 0 to 1", {"", "Share"}, rows_of(service, shares));
    tables += table("Record", {"", "Value"},
                    rows_of(quality, {{"rows", "Rows"},
                                      {"duration", with_unit("Duration", s.time)},
                                      {"sample_time", with_unit("Time between rows", s.time)},
                                      {"missing", "Share of rows without a measurement"},
                                      {"held", "Share of repeated measurements"},
                                      {"at_limit", "Share of rows at an end of the measurement's range"},
                                      {"longest_gap", with_unit("Longest gap", s.time)},
                                      {"noise", with_unit("Noise of the measurement", s.y)},
                                      {"y_step", with_unit("Smallest step of the measurement; 0: none found", s.y)},
                                      {"u_step", with_unit("Smallest step of the output; 0: none found", s.u)}}));
    std::vector<std::pair<const char*, std::string>> with_reasons = moves;
    with_reasons.emplace_back("harris", "Harris range");
    return section("Figures", element("div", tables, {{"class", "tables"}}) + reasons_of(performance, with_reasons) +
                                  reasons_of(service, shares));
}

void add_trace(Plot& plot, const JsonLocation& trend, const char* x, const char* y, const std::string& name,
               Line line) {
    std::vector<double> across = numbers_at(trend.at(x)), up = numbers_at(trend.at(y));
    across.resize(std::min(across.size(), up.size()));
    up.resize(across.size());
    if (!across.empty())
        plot.traces.push_back({.name = name, .line = line, .x = std::move(across), .y = std::move(up)});
}

Html trend_of(const ReportInput& s, const JsonLocation& trend, const std::string& title) {
    Plot measurement{.title = title, .x_label = with_unit("t", s.time), .y_label = with_unit("y", s.y), .traces = {}};
    add_trace(measurement, trend, "t", "y", "Measurement", Line::proposal);
    add_trace(measurement, trend, "t", "r", "Set point", Line::setpoint);
    Plot output{
        .title = title + ", output", .x_label = with_unit("t", s.time), .y_label = with_unit("u", s.u), .traces = {}};
    add_trace(output, trend, "t", "u", "Output", Line::second);
    return drawn(measurement) + drawn(output);
}

Html drawings_of(const ReportInput& s, const JsonLocation& loop) {
    Plot against{.title = "Measurement against output (PV against OP)",
                 .x_label = with_unit("u", s.u),
                 .y_label = with_unit("y", s.y),
                 .traces = {}};
    add_trace(against, loop.at("excerpt"), "u", "y", "Last periods", Line::proposal);
    Plot spectrum{.title = "Power of the error",
                  .x_label = with_unit("Period", s.time),
                  .y_label = "Share",
                  .traces = {},
                  .log_x = true};
    add_trace(spectrum, loop.at("spectrum"), "x", "y", "Share of power", Line::proposal);
    const Html drawings = trend_of(s, loop.at("trend"), "Whole record") +
                          trend_of(s, loop.at("excerpt"), "Last periods") + drawn(against) + drawn(spectrum);
    return drawings.empty() ? Html() : section("Record", element("div", drawings, {{"class", "figures"}}));
}

/// Says that not every loop has a page.
Html limit_of(const ReportInput& s, std::size_t pages) {
    const std::size_t all = s.entry.value().size();
    if (pages == all) return {};
    return element("p", "The pages of " + std::to_string(pages) +
                            " loops follow: the first with a cause in the order "
                            "of the work list, which has all " +
                            std::to_string(all) + " loops.");
}

/// The page of one loop.
Html page_of_loop(const ReportInput& plant, std::size_t place) {
    const JsonLocation loop = plant.entry.at(place), rank = rank_of(plant, place);
    const ReportInput s = with_units(plant, loop.at("units").value());
    std::string source = tag_of_loop(s.result.value(), rank.at("after").value());
    if (!source.empty()) source = "Mend " + source + " first: it disturbs this loop.";
    const std::vector<Html> remarks = sentences_at(loop.at("quality").at("remarks"), "detail");
    const std::vector<Html> readings = sentences_in(loop.at("quality").at("readings"));
    return element("section",
                   element("h1", text_at(loop.at("tag"))) + (source.empty() ? Html() : element("p", source)) +
                       cause_of(loop) + action_of(s, loop, rank) +
                       (remarks.empty() ? Html() : section("Remarks on the record", list(remarks))) +
                       (readings.empty() ? Html() : section("How the file was read", list(readings))) +
                       drawings_of(s, loop) + figures_of(s, loop),
                   {{"class", "loop"}});
}

}  // namespace

Html check_sections(const ReportInput& subject) {
    Html out = work_list_of(subject) + groups_of(subject) + cascades_of(subject) + notes_of_files(subject);
    const std::vector<std::size_t> places = loops_with_page(subject.result.value());
    out += limit_of(subject, places.size());
    for (const std::size_t place : places) out += page_of_loop(subject, place);
    return out;
}

}  // namespace tunewright::api
