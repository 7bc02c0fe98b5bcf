// A record from a seed: a plant, a test, disturbances, and the effects of a logger.
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
    closed_setpoints,   ///< a PI controller, with set-point steps in the record
    closed_regulation,  ///< a PI controller, with loads only
    staircase_between,  ///< moved at any time; the rows show it late
    relay_between,      ///< acts at any time, or once a row at another instant than the logger
};
inline constexpr int kTests = 11;
const char* name_of(Test test);

enum class Noise { none, white, coloured, drifting_load, outliers, missing_rows, irregular_times, logged_on_change };
inline constexpr int kNoises = 8;
const char* name_of(Noise noise);

/// The form in which a user sends the record: columns of numbers, or a file that the product's own reader converts to
/// them (record_form.h).
enum class Form {
    columns,
    several_runs,   ///< the logger was restarted, or its clock set back
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
    double noise_std = 0;    ///< relative to the effect of the test
    bool cut_short = false;  ///< the record ends before y rests
    Record record;
    /// For tests that move u between rows: the same record with rows of u alone at the moves.
    std::optional<Record> with_moves;
    /// Rows from before the test, of the same plant: for several runs and countdowns.
    Record earlier = {};
    std::string text() const;  ///< one line
};

/// Families, tests and noises in turn over the seeds, everything else at random.
MadeRecord make_record(std::uint64_t seed, Form form = Form::columns);

/// A record with some of them given.
MadeRecord make_record(std::uint64_t seed, Family family, Test test, Noise noise, Form form = Form::columns);

/// Simulates a logger: damages, drops or thins the rows according to `noise` (logged_rows.cpp). `size` is the effect of
/// a unit of u; `noise_std` is relative to it.
void log_rows(Noise noise, double noise_std, double size, Record& record, Random& random);

}  // namespace tunewright::records
