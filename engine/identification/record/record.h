// A recorded test as columns of numbers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tunewright {

/// The kind of test in a record, as given by the user or as found (record_kind.h). `several_steps` is only found, never
/// given: fewer than 20 changes of u, without a relay.
enum class RecordKind { automatic, step, several_steps, relay, general };

/// A further measured input that moves y: another heater, a measured disturbance. values[i] holds from t[i] until
/// t[i+1], like u (NaN: as before); as many values as t has.
struct FurtherInput {
    std::string name;
    std::vector<double> values;
};

inline constexpr int kMaxFurtherInputs = 4;

/// Samples in time order as exported (NaN where a number is missing); u[i] holds from t[i] until t[i+1] (zero-order
/// hold). t, u and y have equal lengths; r, automatic and line are empty or as long.
struct Record {
    std::vector<double> t;       ///< time in the user's unit, any start
    std::vector<double> u;       ///< controller output (plant input)
    std::vector<double> y;       ///< measurement
    std::vector<double> r = {};  ///< set point, in y's unit, a number in each row; empty: none
    /// The loop's mode in each row: true in automatic and in cascade; empty: not recorded.
    std::vector<bool> automatic = {};
    RecordKind kind = RecordKind::automatic;
    std::optional<double> u0, y0;  ///< values before the first sample, in the record's units

    /// low < high: the range of the actuator; u beyond it has no further effect.
    std::optional<std::array<double, 2>> u_limits = {};

    std::vector<FurtherInput> d = {};  ///< at most kMaxFurtherInputs

    std::vector<int> line = {};  ///< line of each sample in its file, for messages; empty: no file

    /// The upper end of u's scale by its name or unit, such as 100 of percent: usual limits below it are never tried.
    std::optional<double> u_full_scale = {};
};

}  // namespace tunewright
