// Responses before and after, the Nyquist curve and the sensitivities, as drawings.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "api/report/figures.h"
#include "api/report/plot.h"
#include "api/report/sections.h"

namespace tunewright::api {
namespace {

struct Source {
    std::string name;
    Line line;
    JsonLocation place;
};

/// The entries whose traces are drawn.
std::vector<Source> sources_of(const ReportInput& s) {
    std::vector<Source> out = {{"Proposal", Line::proposal, s.entry}};
    if (s.entry.at("implemented").at("responses").exists())
        out.push_back({"Implemented", Line::built, s.entry.at("implemented")});
    if (s.today) out.push_back({"Today", Line::today, *s.today});
    return out;
}

/// Adds y or u of a response; also that of the linear model if the plant is nonlinear.
void add_responses(Plot& plot, const ReportInput& s, const char* step, const char* signal) {
    for (const Source& source : sources_of(s)) {
        const JsonLocation response = source.place.at("responses").at(step);
        if (!response.at(signal).exists()) continue;
        plot.traces.push_back({.name = source.name,
                               .line = source.line,
                               .x = numbers_at(response.at("t")),
                               .y = numbers_at(response.at(signal))});
    }
    const JsonLocation linear = s.entry.at("linear").at("responses").at(step);
    if (linear.at(signal).exists())
        plot.traces.push_back({.name = "Linear model",
                               .line = Line::second,
                               .x = numbers_at(linear.at("t")),
                               .y = numbers_at(linear.at(signal))});
}

/// Adds the set point, from before the step to the end of the longest response.
void add_setpoint(Plot& plot, const ReportInput& s) {
    double end = 0;
    for (const Trace& trace : plot.traces)
        if (!trace.x.empty()) end = std::max(end, trace.x.back());
    if (!(end > 0)) return;
    const Json& given = s.request.at("evaluate").at("setpoint_step").value();
    const double step = given.is_number() ? given.get<double>() : 1;
    plot.traces.push_back({.name = "Set point", .line = Line::setpoint, .x = {0, 0, end}, .y = {0, step, step}});
}

/// Up to the longest horizon; with the request's limits of u, if any.
Plot response(const ReportInput& s, const char* title, const char* step, const char* signal, const std::string& unit) {
    Plot plot{.title = title, .x_label = with_unit("t", s.time), .y_label = with_unit(signal, unit), .traces = {}};
    add_responses(plot, s, step, signal);
    if (*signal == 'y' && std::string_view(step) == "setpoint") add_setpoint(plot, s);
    const JsonLocation actuator = s.request.at("evaluate").at("actuator");
    if (*signal == 'u' && actuator.exists())
        for (const char* end : {"min", "max"})
            if (actuator.at(end).value().is_number())
                plot.limits.emplace_back(std::string(end) + " of u", actuator.at(end).value().get<double>());
    return plot;
}

/// The recorded traces, and the replayed ones of the entry's controller; empty if there is no replay.
Plot replayed(const ReportInput& s) {
    const JsonLocation record = s.result.at("replay"), replay = s.entry.at("replay");
    const std::vector<double> t = numbers_at(record.at("t"));
    Plot plot{.title = "Replay of the record: y",
              .x_label = with_unit("t", s.time),
              .y_label = with_unit("y", s.y),
              .traces = {}};
    if (t.empty() || !replay.at("y").exists()) return plot;
    plot.traces = {{.name = "New", .line = Line::proposal, .x = t, .y = numbers_at(replay.at("y"))},
                   {.name = "Recorded", .line = Line::today, .x = t, .y = numbers_at(record.at("y"))},
                   {.name = "Set point", .line = Line::setpoint, .x = t, .y = numbers_at(record.at("r"))}};
    return plot;
}

double limit_of(const ReportInput& s, const char* name) {
    const Json& value = s.entry.at("options").at(name).value();
    return value.is_number() ? value.get<double>() : 0;
}

/// Far beyond the crossover a dead time turns around the origin many times; that part is irrelevant and would print as
/// a blot.
void cut_turns(Trace& trace, const JsonLocation& entry) {
    constexpr double kMaxFrequencyOverCrossover = 10;
    const Json& crossover = entry.at("robustness").at("gain_crossover").value();
    const std::vector<double> omega = numbers_at(entry.at("frequency").at("omega"));
    if (!crossover.is_number() || omega.size() != trace.x.size()) return;
    const double max = kMaxFrequencyOverCrossover * crossover.get<double>();
    const auto end = std::upper_bound(omega.begin(), omega.end(), max) - omega.begin();
    trace.x.resize(static_cast<std::size_t>(end));
    trace.y.resize(static_cast<std::size_t>(end));
}

Html nyquist(const ReportInput& s) {
    Plot plot{.title = "Nyquist curve of L", .x_label = "Re", .y_label = "Im", .traces = {}};
    for (const Source& source : sources_of(s)) {
        const JsonLocation L = source.place.at("frequency").at("L");
        if (!L.at("re").exists()) continue;
        plot.traces.push_back(
            {.name = source.name, .line = source.line, .x = numbers_at(L.at("re")), .y = numbers_at(L.at("im"))});
        cut_turns(plot.traces.back(), source.place);
    }
    const double Ms = limit_of(s, "Ms"), Mt = limit_of(s, "Mt");
    if (Ms > 1) plot.circles.push_back({"Ms " + number_text(Ms), -1, 0, 1 / Ms});
    if (Mt > 1) plot.circles.push_back({"Mt " + number_text(Mt), -Mt * Mt / (Mt * Mt - 1), 0, Mt / (Mt * Mt - 1)});
    // Only the point -1 and its neighbourhood matter; the ends of the curve may lie outside.
    plot.equal = true;
    plot.x_range = {-2.6, 1.2};
    plot.y_range = {-1.8, 1.0};
    return drawn(plot);
}

/// The frequencies from large to small L: two decades on both sides of the gain crossover, or all.
std::optional<std::pair<double, double>> band(const ReportInput& s) {
    const Json& crossover = s.entry.at("robustness").at("gain_crossover").value();
    const std::vector<double> omega = numbers_at(s.entry.at("frequency").at("omega"));
    if (omega.size() < 2 || !(omega.front() > 0)) return std::nullopt;
    if (!crossover.is_number()) return std::pair{omega.front(), omega.back()};
    const double middle = crossover.get<double>(), low = std::max(omega.front(), middle / 100),
                 high = std::min(omega.back(), middle * 100);
    return low < high ? std::pair{low, high} : std::pair{omega.front(), omega.back()};
}

Html sensitivities(const ReportInput& s) {
    Plot plot{.title = "Sensitivities", .x_label = "ω (rad/" + s.time + ")", .y_label = "|S|, |T|", .traces = {}};
    plot.log_x = true;
    plot.x_range = band(s);
    if (!plot.x_range) return {};
    double top = 1;
    for (const auto& [member, name, line] :
         {std::tuple{"S_abs", "|S|", Line::proposal}, std::tuple{"T_abs", "|T|", Line::built}}) {
        const JsonLocation frequency = s.entry.at("frequency");
        plot.traces.push_back({.name = name,
                               .line = line,
                               .x = numbers_at(frequency.at("omega")),
                               .y = numbers_at(frequency.at(member))});
        for (const double value : plot.traces.back().y) top = std::isfinite(value) ? std::max(top, value) : top;
    }
    if (s.today && s.today->at("frequency").at("S_abs").exists()) {
        const JsonLocation frequency = s.today->at("frequency");
        plot.traces.push_back({.name = "|S| today",
                               .line = Line::today,
                               .x = numbers_at(frequency.at("omega")),
                               .y = numbers_at(frequency.at("S_abs"))});
        for (const double value : plot.traces.back().y) top = std::isfinite(value) ? std::max(top, value) : top;
    }
    constexpr double kHighest = 6;
    for (const char* name : {"Ms", "Mt"})
        if (limit_of(s, name) > 1)
            plot.limits.emplace_back(name + (" " + number_text(limit_of(s, name))), limit_of(s, name));
    plot.y_range = {0, std::min(kHighest, 1.1 * top)};
    return drawn(plot);
}

}  // namespace

std::vector<Plot> response_plots(const ReportInput& s) {
    return {response(s, "Set-point step: y", "setpoint", "y", s.y), response(s, "Load step: y", "load", "y", s.y),
            response(s, "Set-point step: u", "setpoint", "u", s.u), response(s, "Load step: u", "load", "u", s.u)};
}

std::vector<Plot> own_step_plots(const ReportInput& s) {
    Plot y{
        .title = "Your own step: y", .x_label = with_unit("t", s.time), .y_label = with_unit("y", s.y), .traces = {}};
    Plot u{
        .title = "Your own step: u", .x_label = with_unit("t", s.time), .y_label = with_unit("u", s.u), .traces = {}};
    const JsonLocation step = s.request.at("evaluate").at("own_step");
    for (const Source& source : sources_of(s)) {
        const JsonLocation trace = source.place.at("own_step").at("trace");
        if (!trace.at("t").exists()) continue;
        const std::vector<double> t = numbers_at(trace.at("t"));
        if (y.traces.empty()) {
            std::vector<double> times = t, r = numbers_at(trace.at("r"));
            times.insert(times.begin(), 0);
            r.insert(r.begin(), step.at("y").value().is_number() ? step.at("y").value().get<double>() : 0);
            y.traces.push_back({.name = "Set point", .line = Line::setpoint, .x = std::move(times), .y = std::move(r)});
        }
        y.traces.push_back({.name = source.name, .line = source.line, .x = t, .y = numbers_at(trace.at("y"))});
        u.traces.push_back({.name = source.name, .line = source.line, .x = t, .y = numbers_at(trace.at("u"))});
    }
    for (const auto& [member, name] : {std::pair{"u_min", "lowest u"}, {"u_max", "highest u"}})
        if (step.at(member).value().is_number()) u.limits.emplace_back(name, step.at(member).value().get<double>());
    return {y, u};
}

Html responses_section(const ReportInput& s) {
    Html figures;
    for (const Plot& plot : response_plots(s)) figures += drawn(plot);
    if (figures.empty())
        return section("Responses",
                       element("p", "The result has no traces: its request asked for none, or the loop is unstable."));
    Html note;
    if (s.today && !s.today->at("responses").at("load").exists())
        note = element("p", "Today's settings have no response to draw; see the figures.");
    return section("Responses", element("div", figures, {{"class", "figures"}}) + note);
}

Html effect_drawing(const ReportInput& s) {
    const Html replay = drawn(replayed(s));
    return replay.empty() ? drawn(response(s, "Load step: y", "load", "y", s.y)) : replay;
}

Html robustness_section(const ReportInput& s) {
    const Html figures = nyquist(s) + sensitivities(s);
    return figures.empty() ? figures : section("Robustness", element("div", figures, {{"class", "figures"}}));
}

}  // namespace tunewright::api
