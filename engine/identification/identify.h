// A record in, a plant out.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/fit/excited_band.h"
#include "engine/identification/record/record.h"
#include "engine/plant/plant_family.h"
#include "engine/progress.h"
#include "engine/simulation/relay/limit_cycle.h"
#include "engine/warning.h"

namespace tunewright {

enum class ModelChoice { automatic, fopdt, sopdt, sopdt_zero, ipdt, ipdt_lag };
enum class IdentifyMethod { automatic, relay_fourier, output_error, two_point };

struct IdentifyOptions {
    ModelChoice model = ModelChoice::automatic;
    IdentifyMethod method = IdentifyMethod::automatic;
    std::optional<double> shift;  ///< Liu-Gao's alpha (Eq. 9), 1/time
};

struct Candidate {
    Plant plant;
    double fit_percent = 0;  ///< 100 (1 - ||y - yhat||/||y - mean(y)||), free run, offset estimated
    double criterion = 0;    ///< information criterion, smaller is better
    std::map<std::string, double> standard_errors;  ///< K, L and T, or T1, T2, or T, zeta, or a1, a2, b (sopdt_zero)
    std::vector<double> y_model;                    ///< its free run at the times of IdentifiedModel::fit
    bool much_worse = false;                     ///< another candidate fits so much better that nobody need look at it
    std::vector<std::string> undetermined = {};  ///< times that the record does not determine, as named above
};

/// Of the chosen plant's parameters; rows and columns in the order of `names`.
struct ParameterCovariance {
    std::vector<std::string> names;
    std::vector<std::vector<double>> matrix;
    /// Shares of the ends of the 95 % ellipsoid (PlantRegion::ends) that the record leaves possible, 0 to 1; empty: all
    /// of it (fit/uncertainty.h).
    std::vector<double> reach = {};
};

/// The chosen model beside the record: for the plot.
struct FitTrace {
    std::vector<double> t, u, y, y_model;
};

/// Stretches of a record without samples, or without y: how many, the longest, and the time at which it begins.
struct MissingPart {
    int count = 0;
    double longest = 0, at = 0;
};

/// The samples before the first change of u.
struct PreTest {
    int samples = 0;
    double duration = 0;
    double drift = 0;     ///< slope of y, per time
    bool at_rest = true;  ///< y moves by less than 3 % of its range, or no more than its noise explains
};

/// Flat tops of y: what a sensor or a valve at its end leaves.
struct Saturation {
    double level = 0;
    double fraction = 0;  ///< of the samples
};

/// Readings that no process makes; left out.
struct FalseReadings {
    int count = 0;
    std::vector<int> rows;  ///< the first 20, as the notes count rows
};

/// What else than feedback moved u in a loop's record, and was used.
enum class LoopExcitation { set_point, switched_on, outside_moves, none };

/// A controller moved u in answer to y.
struct ClosedLoop {
    std::string evidence;  ///< one sentence
    LoopExcitation used = LoopExcitation::none;
    double share = 0;  ///< of u's variance that it explains, 0 to 1
    /// Moves of the recorded set point (column r), a ramp counted once; empty: not recorded, or it does not move.
    std::optional<int> set_point_moves;
};

/// What was found in the record and what was done about it. Named figures, sentences beside them. In the record's
/// units.
struct DataQuality {
    RecordKind kind = RecordKind::automatic;  ///< as given, or found; never automatic in an answer
    int samples = 0;
    double sample_time = 0;  ///< median spacing
    bool irregular = false;
    double noise_std = 0;                 ///< of y, high-frequency part
    double quantisation = 0;              ///< step of y's grid, 0 if none found
    int steps = 0;                        ///< moves of u
    std::vector<double> move_times = {};  ///< of the first 20 of them
    std::optional<int> cycles;            ///< of a relay test: complete periods of u
    bool settled = false;
    int samples_dropped = 0;                        ///< rows whose y is not used
    double u0 = 0, y0 = 0;                          ///< operating point: given, or before the first change of u
    std::optional<std::array<double, 2>> u_limits;  ///< to which u was cut: given, or found
    std::optional<PreTest> pretest;
    std::optional<MissingPart> gaps;     ///< spacings of more than five times the usual one
    std::optional<MissingPart> missing;  ///< rows without y; `longest` is the longest time from one y to the next
    int repeated_times = 0, backward_times = 0;
    bool time_unit_assumed = false;  ///< nothing names the unit of the times; who reads the file fills it in
    std::vector<Saturation> saturation;
    std::optional<FalseReadings> outliers;
    std::optional<ClosedLoop> closed_loop;
    std::vector<std::string> notes;
};

/// Model of a further measured input (Record::d), for feedforward.
struct DisturbanceModel {
    std::string name;
    Plant plant;  ///< a lag and a dead time (Fopdt); with 1/s (Ipdt) where the plant of u integrates
    std::map<std::string, double> standard_errors;  ///< K, T, L
    double share = 0;  ///< of the variances of what u and the further inputs do to y, 0 to 1
};

struct IdentifiedModel {
    Plant plant;
    double fit_percent = 0;
    std::vector<Candidate> candidates;
    std::map<std::string, double> standard_errors;
    ParameterCovariance covariance;
    std::vector<Plant> alternatives;  ///< fits of other structures, less than 4 above it by Akaike's criterion
    std::vector<DisturbanceModel> disturbances;  ///< the further measured inputs that matter
    std::optional<LimitCycle> limit_cycle;       ///< of a relay test
    std::vector<FrequencyPoint> frequency_points;
    std::optional<UltimatePoint> ultimate_point;  ///< of the plant; empty where no P gain makes it oscillate
    std::string choice_reason;                    ///< why this structure, one sentence
    FitTrace fit;
    std::optional<ExcitedBand> excited_band;
    std::optional<RegionFigures>
        region;  ///< of the best-ranked controller on the 95 % confidence region; tune() fills it
    DataQuality data_quality;
    std::vector<Warning> warnings;
};

/// The plant whose free run, driven by the recorded u from rest at u0 (or the first u), comes nearest to y: least
/// squares over gain, time constants, continuous dead time and offset (output error: Ljung 1999, section 4.2). No
/// resampling: the response to the piecewise constant u is exact at every time stamp.
///
/// - Rows of equal time: the last u counts from that time on, each y is data. Rows out of order or without numbers are
///   dropped; u of a row whose y is no number counts.
/// - `u0`: u stepped from u0 to its first value at the first sample. Without it a start that is not at rest is
///   recognised where the record shows it, and noted. `y0` is weighed as ten samples of y at rest.
/// - `model` automatic fits every structure and keeps the least information criterion, the simpler one where they are
///   equal within noise. `fopdt` may come out with T < 0 (K is negative then too for 1/(s - 1)) from a record in which
///   u changes more than twice.
/// - Rows that are not small beside the dead time show moves of u late (fit/move_times.h): noted, and counted in the
///   standard error of L.
/// - A drift and a lasting load are fitted with the model where the record shows them, and reported as warnings.
/// - Further measured inputs (Record::d) are identified with the plant, each with a gain, a lag and a dead time of its
///   own (further_inputs/further_inputs.h); one that explains nothing is left out, and a note names it.
/// - A relay test also gives `limit_cycle`, `frequency_points`; where no structure fits it, the model is held to the
///   measured response at the oscillation (and to the static gain of a biased test), and a warning says so.
/// - `method` relay_fourier: Liu and Gao's formulas alone; two_point: the construction from one settled step. Neither
///   gives standard errors.
/// - Standard errors and covariance count correlated residuals as the few independent samples they are worth, and what
///   rounding of y does.
/// - Where a controller moves u in answer to y, the model rests on what moves of the set point (column r, or plain
///   kicks of u) do to u and y (closed_loop.h); without any, on its rows in manual (closed_loop/loop_parts.h), and
///   where there are none, the record is refused. Warning closed-loop.
/// - `fit` has at most 2,000 points; of more than 20,000 samples means over blocks are fitted, if the
///   plant is slow beside them; of more than 100,000 always. Warning codes:
///   diagnosis.h, model_answer.cpp, data_quality.h.
///
/// Progress runs from 0 to 1 with stage "identify". Errors: not_identifiable with the cure (fewer than 8 samples, u or
/// y constant, no response, a step in the last samples, fewer than two cycles for relay_fourier); invalid_argument
/// (columns of unequal length, times out of order, a shift that is not above 0); unsupported (a model that the method's
/// formulas do not give); cancelled.
Expected<IdentifiedModel> identify(const Record& record, const IdentifyOptions& options, const RunControl& control);

}  // namespace tunewright
