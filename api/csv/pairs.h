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

/// Splits one line into pairs, in its order; a time in front of them, in brackets or not, or behind them is "time". A
/// printer's letters become words: "T:200.1 /200.0 @:64" becomes "T.temp", "T.target" and "T.pwm". At most 200 pairs.
void split_pairs(std::string_view line, std::vector<Pair>& out);

/// The keys of a log of pairs, in the order in which they appear; empty if the lines are not such a log and may be a
/// table. If lines of several kinds have pairs, the kind whose keys hold the `wanted` names is taken; else one that
/// names a controller output and a measurement; else the most frequent one. Lines with fewer than half of these keys do
/// not count.
std::vector<std::string> pair_keys(std::string_view text, const std::vector<std::string>& wanted = {});

/// True if a line belongs to the log: it holds at least half of the keys. `pairs` are those of the line, `keys` those
/// of the whole log:
///
///     std::vector<Pair> pairs;
///     split_pairs("T:200.1 /200.0 @:64", pairs);  // T.temp 200.1, T.target 200.0, T.pwm 64
bool is_pair_line(const std::vector<Pair>& pairs, const std::vector<std::string>& keys);

}  // namespace tunewright::api
