// A record from a seed: a plant, a test, what disturbs it, and what a logger makes of it.
#pragma once

#include <optional>
#include <string>

#include "engine/identification/record/record.h"
#include "tests/records/true_plant.h"

namespace tunewright::records {

enum class Test {
    step_little_rest,  ///< 0 to 8 rows before the step
    step_much_rest,
    bump,
    staircase,
    prbs,
    ramp,
    relay,
    closed_setpoints,   ///< a PI controller, set-point steps in the record
    closed_regulation,  ///< a PI controller, loads alone
    staircase_between,  ///< moved at any time; the rows show it late
    relay_between,      ///< acts at any time, or once a row at another instant than the logger
};
inline constexpr int kTests = 11;
const char* name_of(Test test);

enum class Noise { none, white, coloured, drifting_load, outliers, missing_rows, irregular_times, logged_on_change };
inline constexpr int kNoises = 8;
const char* name_of(Noise noise);

struct MadeRecord {
    TruePlant plant;
    Test test = Test::step_much_rest;
    Noise noise = Noise::none;
    double noise_std = 0;    ///< relative to what the test moves
    bool cut_short = false;  ///< the record ends before y rests
    Record record;
    /// The same with rows of u alone where u moved: of tests that move u between rows.
    std::optional<Record> with_moves;
    std::string text() const;  ///< one line
};

/// Families, tests and noises in turn over the seeds, everything else at random.
MadeRecord make_record(std::uint64_t seed);

/// The same with some of them given.
MadeRecord make_record(std::uint64_t seed, Family family, Test test, Noise noise);

}  // namespace tunewright::records
