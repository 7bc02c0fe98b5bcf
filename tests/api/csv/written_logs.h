// One simulated test, written in the formats of loggers, printers, controllers and scripts.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tunewright::api {

/// One sample of the same simulated test in every format: u steps from 20 to 50 at the tenth, y follows with a lag of
/// 12 s.
struct Sample {
    int t;
    double u, y;
};

inline constexpr int kSamples = 60;

inline std::vector<Sample> samples() {
    std::vector<Sample> out;
    double y = 20;
    for (int t = 0; t < kSamples; ++t) {
        const double u = t < 10 ? 20 : 50;
        out.push_back({t, u, std::round(100 * y) / 100});
        y += (20 + 0.5 * (u - 20) - y) / 12;
    }
    return out;
}

inline std::string digits(double value, int decimals = 2) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
    return buffer;
}

inline std::string clock(int t) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "14:%02d:%02d", 5 + t / 60, t % 60);
    return buffer;
}

inline const char* on_off(double u) { return u > 30 ? "ON" : "OFF"; }

inline std::string rows(const std::function<std::string(const Sample&)>& row) {
    std::string out;
    for (const Sample& sample : samples()) out += row(sample) + "\n";
    return out;
}

/// "{t},{u},{y}" with the sample's figures; {ms} milliseconds, {clock} the time of day, {on} ON or OFF, {duty} u/100.
inline std::string written(const std::string& form) {
    return rows([&](const Sample& s) {
        std::string line = form;
        const std::pair<const char*, std::string> figures[] = {
            {"{t}", std::to_string(s.t)},       {"{ms}", std::to_string(1000 * s.t)},
            {"{row}", std::to_string(s.t + 1)}, {"{clock}", clock(s.t)},
            {"{late}", clock(2 * s.t)},         {"{u}", digits(s.u, 0)},
            {"{duty}", digits(s.u / 100, 3)},   {"{y}", digits(s.y)},
            {"{e}", digits(40 - s.y)},          {"{on}", on_off(s.u)}};
        for (const auto& [name, text] : figures) {
            for (std::size_t at = line.find(name); at != line.npos; at = line.find(name))
                line.replace(at, std::string(name).size(), text);
        }
        return line;
    });
}

inline std::string with_commas(std::string text) {
    for (char& c : text) c = c == '.' ? ',' : c;
    return text;
}

/// A log of Klipper, whose clock counts seconds since its start. `heaters` is the part of a line that names them, with
/// {y} and {duty}.
inline std::string klipper(const std::string& heaters) {
    std::string out = "Starting Klippy...\n[extruder]\npid_kp = 22.2\nmesh = 0.1, 0.2, 0.3\n";
    for (const Sample& s : samples()) {
        std::string line = "Stats " + digits(12345.6 + s.t, 1) +
                           ": gcodein=0  mcu: mcu_awake=0.002 mcu_task_avg=0.000005 freq=180000000 " + heaters;
        for (const auto& [name, text] : {std::pair{"{y}", digits(s.y)}, {"{duty}", digits(s.u / 100, 3)}}) {
            if (const std::size_t at = line.find(name); at != line.npos) line.replace(at, std::strlen(name), text);
        }
        out += line + " sysload=0.35 print_time=" + digits(s.t, 3) + "\n";
    }
    return out + "Reactor garbage collection: (1, 2, 3)\n";
}

}  // namespace tunewright::api
