// Lines of a log that name each value: "heater_bed: temp=59.9 pwm=0.53", "T:23.4,PWM:120", {"temp": 20.5, "pwm": 30}.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::api {

struct Pair {
    std::string key;         ///< with the words that lead it: "heater_bed.temp"
    std::string_view value;  ///< a number, a quoted time stamp or a word such as ON
};

/// The pairs of one line, in its order; a time in front of them, in brackets or not, or behind them is "time". What
/// printers write gets words: "T:200.1 /200.0 @:64" becomes "T.temp", "T.target" and "T.pwm". At most 200.
void split_pairs(std::string_view line, std::vector<Pair>& out);

/// The keys of a log of pairs, in the order in which they come; empty where the lines are no such log, and a table may
/// be. Where lines of several kinds have pairs, those are taken whose keys hold the `wanted` names; else those that
/// name a controller output and a measurement; else the most. Lines between them that hold fewer than half of these
/// keys count for nothing.
std::vector<std::string> pair_keys(std::string_view text, const std::vector<std::string>& wanted = {});

/// Whether a line belongs to the log: it holds at least half of the keys. `pairs` are those of the line, `keys` those
/// of the whole log:
///
///     std::vector<Pair> pairs;
///     split_pairs("T:200.1 /200.0 @:64", pairs);  // T.temp 200.1, T.target 200.0, T.pwm 64
bool is_pair_line(const std::vector<Pair>& pairs, const std::vector<std::string>& keys);

}  // namespace tunewright::api
