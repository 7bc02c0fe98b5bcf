#include "api/report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "api/report/figures.h"

namespace tunewright::api {
namespace {

constexpr double kWidth = 340, kHeight = 210;                      // px of the viewBox
constexpr double kLeft = 46, kRight = 10, kTop = 8, kBottom = 34;  // margins around the frame
constexpr double kTickLength = 4;
constexpr int kTickDigits = 6;  // as many as a tick may need

struct Style {
    const char *colour, *width, *dashes;
};

const Style& style_of(Line line) {
    static constexpr std::array<Style, 6> kStyles = {{{"#2363c5", "1.8", ""},
                                                      {"#a96108", "1.5", "6 4"},
                                                      {"#0f4421", "1.5", "12 3"},
                                                      {"#4a5460", "0.8", ""},
                                                      {"#8a6d00", "0.9", "3 3"},
                                                      {"#802073", "1.5", "2 3"}}};
    return kStyles[static_cast<std::size_t>(line)];
}

std::string px(double value) { return fmt::format("{:.2f}", value); }

struct Axis {
    double low = 0, high = 1;  ///< limits of the axis; log10 of them if `log`
    bool log = false;
    double from = 0, to = 1;  ///< px

    double at(double value) const {
        const double x = log ? std::log10(value) : value;
        return from + (x - low) / (high - low) * (to - from);
    }
};

Range range_of(const Plot& plot, bool of_x) {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto take = [&](double value) {
        if (!std::isfinite(value) || (of_x && plot.log_x && value <= 0)) return;
        range.first = std::min(range.first, value);
        range.second = std::max(range.second, value);
    };
    for (const Trace& trace : plot.traces)
        for (const double value : of_x ? trace.x : trace.y) take(value);
    if (!of_x)
        for (const auto& [name, value] : plot.limits) take(value);
    return range;
}

/// The range with some room above and below; a constant has some on both sides.
Range with_room(Range range) {
    const double size = std::max(std::abs(range.first), std::abs(range.second));
    const double room = range.second - range.first > 1e-9 * size ? 0.06 * (range.second - range.first)
                        : size > 0                               ? 0.1 * size
                                                                 : 1;
    return {range.first - room, range.second + room};
}

Axis axis_of(Range range, bool log, double from, double to) {
    if (log) range = {std::log10(range.first), std::log10(range.second)};
    if (!(range.second > range.first)) range.second = range.first + 1;
    return {range.first, range.second, log, from, to};
}

/// Makes the units of both axes equal: the axis with the larger scale shows more.
void make_equal(Axis& x, Axis& y) {
    const double unit_x = std::abs(x.to - x.from) / (x.high - x.low),
                 unit_y = std::abs(y.to - y.from) / (y.high - y.low);
    Axis& wide = unit_x > unit_y ? x : y;
    const double unit = std::min(unit_x, unit_y), middle = (wide.low + wide.high) / 2;
    const double half = std::abs(wide.to - wide.from) / unit / 2;
    wide.low = middle - half;
    wide.high = middle + half;
}

std::vector<double> ticks_of(const Axis& axis, int count) {
    if (axis.log) return log_ticks(std::pow(10, axis.low), std::pow(10, axis.high));
    return ticks(axis.low, axis.high, count);
}

Html label(double x, double y, const Html& text, const char* anchor) {
    return element("text", text, {{"x", px(x)}, {"y", px(y)}, {"text-anchor", anchor}});
}

Html line(double x1, double y1, double x2, double y2, const char* colour) {
    return empty_element("path", {{"d", "M" + px(x1) + " " + px(y1) + "L" + px(x2) + " " + px(y2)},
                                  {"stroke", colour},
                                  {"stroke-width", "0.6"},
                                  {"fill", "none"}});
}

Html axes(const Plot& plot, const Axis& x, const Axis& y) {
    Html out;
    for (const double tick : ticks_of(x, 6)) {
        const double at = x.at(tick);
        out += line(at, y.from, at, y.to, "#e3e8ed") + line(at, y.from, at, y.from + kTickLength, "#566270");
        out += label(at, y.from + 14, number_text(tick, kTickDigits), "middle");
    }
    for (const double tick : ticks_of(y, 5)) {
        const double at = y.at(tick);
        out += line(x.from, at, x.to, at, "#e3e8ed") + line(x.from - kTickLength, at, x.from, at, "#566270");
        out += label(x.from - 6, at + 3.5, number_text(tick, kTickDigits), "end");
    }
    out += empty_element("rect", {{"x", px(x.from)},
                                  {"y", px(y.to)},
                                  {"width", px(x.to - x.from)},
                                  {"height", px(y.from - y.to)},
                                  {"fill", "none"},
                                  {"stroke", "#7d8896"},
                                  {"stroke-width", "0.8"}});
    out += label((x.from + x.to) / 2, kHeight - 4, plot.x_label, "middle");
    return out + element("text", plot.y_label,
                         {{"transform", "translate(11 " + px((y.from + y.to) / 2) + ") rotate(-90)"},
                          {"text-anchor", "middle"}});
}

/// The line in px; points far outside are moved close to the frame, so that numbers stay small.
std::string path_of(const Trace& trace, const Axis& x, const Axis& y) {
    constexpr double kMaxPixel = 5000;
    std::string out;
    bool drawing = false;
    for (std::size_t i = 0; i < std::min(trace.x.size(), trace.y.size()); ++i) {
        const double px_x = x.at(trace.x[i]), px_y = y.at(trace.y[i]);
        if (!std::isfinite(px_x) || !std::isfinite(px_y)) {
            drawing = false;
            continue;
        }
        out += (drawing ? "L" : "M") + px(std::clamp(px_x, -kMaxPixel, kMaxPixel)) + " " +
               px(std::clamp(px_y, -kMaxPixel, kMaxPixel));
        drawing = true;
    }
    return out;
}

Html stroke(Line line, const std::string& path) {
    const Style& style = style_of(line);
    return empty_element("path", {{"d", path},
                                  {"fill", "none"},
                                  {"stroke", style.colour},
                                  {"stroke-width", style.width},
                                  {"stroke-dasharray", style.dashes},
                                  {"stroke-linejoin", "round"}});
}

Html circle_of(const Circle& circle, const Axis& x, const Axis& y) {
    const Style& style = style_of(Line::limit);
    return empty_element("circle", {{"cx", px(x.at(circle.x))},
                                    {"cy", px(y.at(circle.y))},
                                    {"r", px(x.at(circle.x + circle.r) - x.at(circle.x))},
                                    {"fill", "none"},
                                    {"stroke", style.colour},
                                    {"stroke-width", style.width},
                                    {"stroke-dasharray", style.dashes}});
}

Html inside_of(const Plot& plot, const Axis& x, const Axis& y) {
    Html out;
    for (const auto& [name, height] : plot.limits)
        out += stroke(Line::limit, "M" + px(x.from) + " " + px(y.at(height)) + "L" + px(x.to) + " " + px(y.at(height)));
    for (const Circle& circle : plot.circles) out += circle_of(circle, x, y);
    for (const Trace& trace : plot.traces) out += stroke(trace.line, path_of(trace, x, y));
    return out;
}

Html key(Line line, const std::string& name) {
    const Html sample = element("svg", stroke(line, "M0 4L30 4"),
                                {{"viewBox", "0 0 30 8"}, {"width", "30"}, {"height", "8"}, {"aria-hidden", "true"}});
    return element("span", sample + " " + name, {{"class", "key"}});
}

Html legend(const Plot& plot) {
    Html keys;
    for (const Trace& trace : plot.traces)
        if (!trace.name.empty()) keys += key(trace.line, trace.name);
    std::string limits;
    for (const auto& [name, height] : plot.limits) limits += (limits.empty() ? "" : ", ") + name;
    for (const Circle& circle : plot.circles) limits += (limits.empty() ? "" : ", ") + circle.name;
    if (!limits.empty()) keys += key(Line::limit, limits);
    return keys;
}

}  // namespace

std::vector<double> ticks(double low, double high, int count) {
    const double rough = (high - low) / count, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = (rough <= power ? 1 : rough <= 2 * power ? 2 : rough <= 5 * power ? 5 : 10) * power;
    std::vector<double> out;
    if (!(step > 0) || !std::isfinite(step)) return out;
    for (double n = std::ceil(low / step - 1e-9); n * step <= high + 1e-9 * step && out.size() < 50; ++n)
        out.push_back(n * step + 0.0);  // no -0
    return out;
}

std::vector<double> log_ticks(double low, double high) {
    const int first = static_cast<int>(std::floor(std::log10(low))),
              last = static_cast<int>(std::ceil(std::log10(high)));
    const bool parted = last - first <= 3;
    const int stride = std::max(1, (last - first + 7) / 8);
    std::vector<double> out;
    for (int decade = first; decade <= last; decade += parted ? 1 : stride)
        for (const int part : {1, 2, 5}) {
            const double value = part * std::pow(10, decade);
            if ((part == 1 || parted) && value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) out.push_back(value);
        }
    return out;
}

std::optional<Frame> frame_of(const Plot& plot) {
    const Frame frame{plot.x_range.value_or(range_of(plot, true)),
                      plot.y_range ? *plot.y_range : with_room(range_of(plot, false))};
    const bool finite = std::isfinite(frame.x.first) && std::isfinite(frame.y.first) && frame.x.second > frame.x.first;
    return finite ? std::optional(frame) : std::nullopt;
}

namespace {

Html picture_of(const Plot& plot, const Frame& given) {
    Axis x = axis_of(given.x, plot.log_x, kLeft, kWidth - kRight);
    Axis y = axis_of(given.y, false, kHeight - kBottom, kTop);
    if (plot.equal) make_equal(x, y);
    // A nested SVG inside the frame cuts off everything outside.
    const Html frame = element("svg", inside_of(plot, x, y),
                               {{"x", px(kLeft)},
                                {"y", px(kTop)},
                                {"width", px(kWidth - kRight - kLeft)},
                                {"height", px(kHeight - kBottom - kTop)},
                                {"viewBox", px(kLeft) + " " + px(kTop) + " " + px(kWidth - kRight - kLeft) + " " +
                                                px(kHeight - kBottom - kTop)}});
    return element("svg", axes(plot, x, y) + frame,
                   {{"xmlns", "http://www.w3.org/2000/svg"},
                    {"viewBox", "0 0 " + px(kWidth) + " " + px(kHeight)},
                    {"role", "img"},
                    {"aria-label", plot.title}});
}

/// The title, then a sample and the name of each line.
Html caption_of(const Plot& plot) {
    constexpr double kLetter = 6.2, kSample = 22;  // px, about
    Html out = element("text", plot.title, {{"x", px(kLeft)}, {"y", "12"}, {"font-weight", "bold"}});
    double at = kLeft + kLetter * static_cast<double>(plot.title.size()) + 14;
    for (const Trace& trace : plot.traces) {
        if (trace.name.empty()) continue;
        out += stroke(trace.line, "M" + px(at) + " 8L" + px(at + kSample) + " 8");
        out += element("text", trace.name, {{"x", px(at + kSample + 4)}, {"y", "12"}});
        at += kSample + 14 + kLetter * static_cast<double>(trace.name.size());
    }
    return out;
}

}  // namespace

Html drawn(const Plot& plot) {
    const auto frame = frame_of(plot);
    if (!frame) return {};
    return element(
        "figure", element("figcaption", element("strong", plot.title) + " " + legend(plot)) + picture_of(plot, *frame));
}

std::string svg_file(const std::vector<Plot>& plots) {
    constexpr double kScale = 2, kCaption = 18, kGap = 8;  // a plot is twice as large as on paper
    Html inside = element("style", Html::trusted("text{font:10.5px system-ui,sans-serif;fill:#17202a}"));
    inside += empty_element("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "#fff"}});
    double top = kGap;
    for (const Plot& plot : plots) {
        const auto frame = frame_of(plot);
        if (!frame) continue;
        inside += element("g", caption_of(plot), {{"transform", "translate(0 " + px(top) + ")"}});
        inside += element("svg", picture_of(plot, *frame),
                          {{"y", px(top + kCaption)}, {"width", px(kWidth)}, {"height", px(kHeight)}});
        top += kCaption + kHeight + kGap;
    }
    return element("svg", inside,
                   {{"xmlns", "http://www.w3.org/2000/svg"},
                    {"viewBox", "0 0 " + px(kWidth) + " " + px(top)},
                    {"width", px(kScale * kWidth)},
                    {"height", px(kScale * top)}})
               .markup() +
           "\n";
}

}  // namespace tunewright::api
