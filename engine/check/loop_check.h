// What a record of a loop in operation says about it: its service, whether it oscillates, why, what a controller could
// do, and what to do first. The judgement of many loops together: plant_check.h.
#pragma once

#include <array>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/check/pace/loop_law.h"
#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/identification/record/record.h"
#include "engine/warning.h"

namespace tunewright::check {

enum class LoopKind { unknown, flow, pressure, level, temperature, composition };

/// Why the loop is as it is. `insufficient_data`: the record is too short, too coarse or too full of gaps;
/// `undetermined`: it is good enough, but does not tell.
enum class Verdict {
    healthy,
    stiction,
    backlash,
    tight,
    sluggish,
    external,
    saturation,
    quantised,
    manual,
    frozen,
    undetermined,
    insufficient_data
};

/// `open`: the verdict is undetermined or insufficient_data.
enum class Confidence { sure, likely, open };

/// Names of the units, for sentences; empty: unknown.
struct UnitNames {
    std::string time, y, u;

    std::string time_text(double value) const;  ///< "54.0 s"
    std::string y_text(double value) const;
    std::string u_text(double value) const;
};

/// One loop's record, with what its owner knows. Units: y and r in the measurement's unit, u in the output's, time in
/// the record's.
struct LoopQuestion {
    std::string tag;
    LoopKind kind = LoopKind::unknown;
    std::optional<bool> averaging;  ///< a level that smooths flows: its variability is its purpose; empty: not known
    Record record;
    std::optional<double> start;                            ///< s since 1970 of t = 0
    std::optional<std::array<double, 2>> y_range, u_range;  ///< of the transmitter, of the output
    std::optional<ParallelPid> controller;                  ///< today's settings
    std::optional<double> weight;                           ///< money per unit of |e| and hour
    std::optional<double> seconds = 1;                      ///< in a unit of the record's time; empty: not known
    UnitNames units;
    std::optional<std::string> unreadable = {};  ///< why there is no record, a sentence: then its answer says only that
    std::vector<std::string> notes = {};         ///< findings of reading the record, for the remarks on it
    std::vector<std::string> readings = {};      ///< how its file was read, where that was decided and not told
};

/// How good the record is. Shares are of the rows or of the time, 0 to 1.
struct RecordQuality {
    int rows = 0;
    double sample_time = 0;   ///< time
    double duration = 0;      ///< time
    double missing = 0;       ///< share of rows without a usable measurement
    double held = 0;          ///< share of rows that repeat the measurement of the row before: compressed, or quantised
    double longest_gap = 0;   ///< time
    double noise = 0;         ///< standard deviation from sample to sample, y
    double y_step = 0;        ///< grid of the measurement, y; 0: none found
    double u_step = 0;        ///< grid of the output, u; 0: none found
    Figure at_limit;          ///< share of rows with a measurement at an end of the transmitter's range
    bool compressed = false;  ///< most rows lie on stairs or straight lines of a historian
    bool enough = true;       ///< for a diagnosis
    std::vector<Warning> remarks;
    std::vector<std::string> readings;  ///< how the file was read, no fault of the record
};

/// Shares of the time, 0 to 1. A figure without a value was not recorded.
struct ServiceShares {
    Figure automatic, manual;
    double saturated_low = 0, saturated_high = 0;
    double output_still = 0;       ///< output and set point constant while the measurement moves
    double measurement_still = 0;  ///< measurement constant while the output moves
    double longest_still = 0;      ///< the same in one piece, if it is far longer than the other pieces
};

/// One oscillation of the error.
struct Period {
    double period = 0;        ///< time
    double period_error = 0;  ///< standard error, time
    double regularity = 0;    ///< above 1: regular (Thornhill, Huang, Zhang 2003)
    double share = 0;         ///< of the error's variance, 0 to 1
    double amplitude = 0;     ///< sqrt(2) standard deviations of its band, y
};

/// Strongest first.
struct Oscillation {
    bool found = false;
    std::vector<Period> periods;
};

/// One figure that speaks for or against a cause; `limit`: the value at which it would turn.
struct Evidence {
    std::string code;  ///< kebab-case, stable
    double value = 0;
    std::optional<double> limit;
    std::string detail;  ///< one sentence with the figure
};

struct Cause {
    Verdict verdict = Verdict::undetermined;
    Confidence confidence = Confidence::open;
    std::vector<Evidence> evidence = {};     ///< in the order in which it was found
    std::vector<Verdict> alternatives = {};  ///< the likeliest first
    Figure size = {};                        ///< width of the dead band and stick, or of the backlash; u
    Figure jump = {};                        ///< of the valve when it breaks loose, u
    Figure period = {};                      ///< of the cycle that this cause makes, time
    std::string why_open = {};               ///< one sentence, if the verdict is open
};

/// The variance of the error that no controller with that delay can avoid, over the variance it has: between 0 and 1, 1
/// is best (Harris 1989; Desborough and Harris 1992).
struct HarrisRange {
    double low = 0, high = 0;
    std::array<double, 2> delays{};  ///< shortest and longest delay, time
};

struct PerformanceFigures {
    OrReason<HarrisRange> harris;
    Figure idle_index;         ///< -1 to 1: above 0.4 sluggish, below -0.4 quick (Hägglund 1999)
    double variability = 0;    ///< standard deviation of the error, y
    Figure variability_share;  ///< the same over the range of the measurement
    double mean_error = 0;     ///< mean magnitude of the error, y
    double independent = 0;    ///< values of the error that count as independent
    Figure following;          ///< variance of the error over that of the set point, where the set point moves
    double offset = 0;         ///< mean of the error, y
    Figure travel;             ///< of the output, share of its range per hour
    Figure reversals;          ///< of the output, per hour
};

/// What to do first, and who does it.
enum class ActionCode {
    none,
    retune,
    repair_valve,
    find_source,
    return_to_automatic,
    check_range,
    check_transmitter,
    record_again,
    test
};
enum class Owner { nobody, control, instruments, process, operations };
struct Action {
    ActionCode code = ActionCode::none;
    Owner owner = Owner::nobody;
    std::string detail;  ///< one sentence
};

/// What the judgement of many loops needs of one: small enough to be kept for thousands.
struct Shape {
    double from = 0, to = 0;  ///< s, since 1970 if the record has a date, else since t = 0
    bool dated = false;
    double period = 0;                     ///< of the strongest regular oscillation, s; 0: none
    std::vector<float> spectrum;           ///< share of the error's power in each of kShapeBands bands of period
    std::vector<float> wave;               ///< the error's last periods, in deviations, a row every wave_step
    double wave_from = 0, wave_step = 0;   ///< s, like from
    std::vector<float> set_point, output;  ///< means of kShapeMeans stretches; empty: not recorded or constant
};
inline constexpr int kShapeBands = 96, kShapePoints = 1024, kShapeMeans = 256;
/// The bands of Shape::spectrum are even in ln(period), s.
inline constexpr double kShortestBand = 1, kLongestBand = 1e5;

/// The record as drawn: extremes of even stretches, in pairs.
struct Trend {
    std::vector<double> t, y, r, u;  ///< r empty: no set point
};

/// Powers or correlations over periods or lags.
struct Curve {
    std::vector<double> x, y;
};

struct LoopCheck {
    std::string tag;
    LoopKind kind = LoopKind::unknown;
    RecordQuality quality;
    ServiceShares service;
    Oscillation oscillation;
    Cause cause;
    PerformanceFigures performance;
    Action action;
    std::optional<double> weight;
    UnitNames units;  ///< of the sentences
    LoopLaw law;
    Shape shape;
    Trend trend;            ///< the whole record, 4 kTrendStretches points at most
    Trend excerpt;          ///< its last periods, row by row
    Curve spectrum;         ///< share of power over period, time
    Curve autocorrelation;  ///< of the error over lag, time
};
inline constexpr int kTrendStretches = 100;

/// Errors: invalid_argument for columns of unequal lengths or a range that is not one; cancelled. A record that is too
/// poor for a diagnosis, or that could not be read, is no error.
Expected<LoopCheck> check_loop(const LoopQuestion& question, const std::stop_token& stop);

/// The check of a loop whose record could not be read, for that reason: a sentence.
LoopCheck unreadable_loop(std::string tag, std::string reason);

}  // namespace tunewright::check
