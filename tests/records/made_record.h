// A record from a seed: a plant, a test, what disturbs it, and what a logger makes of it.
#pragma once

#include <cstdint>
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

/// The form in which a user sends it: columns of numbers, or a file that the product's own reader turns into them
/// (record_form.h).
enum class Form {
    columns,
    several_runs,   ///< the logger was started again, or its clock set back
    countdown,      ///< the times count down to the test, or throughout
    damaged_cells,  ///< words, cut numbers, half lines
    two_inputs,     ///< a second measured input moves y too
};
inline constexpr int kForms = 5;
const char* name_of(Form form);

struct MadeRecord {
    std::uint64_t seed = 0;
    TruePlant plant;
    Test test = Test::step_much_rest;
    Noise noise = Noise::none;
    Form form = Form::columns;
    double noise_std = 0;    ///< relative to what the test moves
    bool cut_short = false;  ///< the record ends before y rests
    Record record;
    /// The same with rows of u alone where u moved: of tests that move u between rows.
    std::optional<Record> with_moves;
    /// Rows from before the test, of the same plant: of several runs and countdowns.
    Record earlier = {};
    std::string text() const;  ///< one line
};

/// Families, tests and noises in turn over the seeds, everything else at random.
MadeRecord make_record(std::uint64_t seed, Form form = Form::columns);

/// The same with some of them given.
MadeRecord make_record(std::uint64_t seed, Family family, Test test, Noise noise, Form form = Form::columns);

/// Acts as a logger: spoils, drops or thins the rows in the way of `noise` (logged_rows.cpp). `size` is what a unit
/// of u moves, `noise_std` relative to it.
void log_rows(Noise noise, double noise_std, double size, Record& record, Random& random);

}  // namespace tunewright::records
