// A plot for print, as SVG: lines differ in colour and in their dashes.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/report/html.h"

namespace tunewright::api {

enum class Line { proposal, today, built, setpoint, limit, second };

struct Trace {
    std::string name;  ///< in the legend; "" for none
    Line line = Line::proposal;
    std::vector<double> x, y;  ///< a value that is not finite interrupts the line
};

struct Circle {
    std::string name;
    double x = 0, y = 0, r = 0;
};

struct Plot {
    std::string title, x_label, y_label;
    std::vector<Trace> traces;
    std::vector<Circle> circles = {};
    std::vector<std::pair<std::string, double>> limits = {};  ///< name and value of horizontal lines over the whole
                                                              ///< width
    bool log_x = false;
    bool equal = false;                                                   ///< a unit has the same length on both axes
    std::optional<std::pair<double, double>> x_range = {}, y_range = {};  ///< otherwise the range of the traces
};

using Range = std::pair<double, double>;

/// The range of a drawing along each axis; empty if no trace has two finite points.
struct Frame {
    Range x, y;
};
std::optional<Frame> frame_of(const Plot& plot);

/// A <figure> element with the drawing and its legend; empty if the plot has no frame.
Html drawn(const Plot& plot);

/// The drawings one below the other as a separate file, each with its title and the names of its lines.
std::string svg_file(const std::vector<Plot>& plots);

/// Multiples of 1, 2 or 5 times a power of ten within the range, about `count` of them.
std::vector<double> ticks(double low, double high, int count);
/// 1, 2, 5 of each decade within the range, or only whole decades if there are many. 0 < low < high.
std::vector<double> log_ticks(double low, double high);

}  // namespace tunewright::api
