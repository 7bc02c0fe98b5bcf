// Identification: a record in, a plant out.
#pragma once

#include <map>
#include <memory>
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
    bool much_worse = false;                        ///< the best candidate fits better by more than 3 points of
                                                    ///< fit_percent
    std::vector<std::string> undetermined = {};     ///< times that the record does not determine, as named above
};

/// Covariance of the chosen plant's parameters; rows and columns in the order of `names`.
struct ParameterCovariance {
    std::vector<std::string> names;
    std::vector<std::vector<double>> matrix;
    /// Shares of the ends of the 95 % ellipsoid (PlantRegion::ends) that are consistent with the record, 0 to 1; empty:
    /// all of it (fit/uncertainty.h).
    std::vector<double> reach = {};
};

/// The chosen model and the record, for the plot.
struct FitTrace {
    std::vector<double> t, u, y, y_model;
};

/// Intervals of a record without samples, or without y: their number, the longest, and the time at which that begins.
struct MissingPart {
    int count = 0;
    double longest = 0, at = 0;
};

/// The samples before the first change of u.
struct PreTest {
    int samples = 0;
    double duration = 0;
    double drift = 0;     ///< slope of y, per time
    bool at_rest = true;  ///< y moves by less than 3 % of its range, or by no more than its noise
};

/// Flat tops of y: a sensor or a valve was at its end.
struct Saturation {
    double level = 0;
    double fraction = 0;  ///< share of the samples
};

/// Physically impossible readings, which were removed.
struct FalseReadings {
    int count = 0;
    std::vector<int> rows;  ///< the first 20, numbered as in the notes
};

/// The moves of u in a loop's record, other than feedback, that were used.
enum class LoopExcitation { set_point, switched_on, outside_moves, none };

/// A controller moved u in response to y.
struct ClosedLoop {
    std::string evidence;  ///< one sentence
    LoopExcitation used = LoopExcitation::none;
    double share = 0;  ///< of u's variance that it explains, 0 to 1
    /// Moves of the recorded set point (column r), a ramp counted once; empty: not recorded, or it does not move.
    std::optional<int> set_point_moves;
};

/// The figures of a record, and what was done with it. Figures have names, with sentences as notes. In the record's
/// units.
struct DataQuality {
    RecordKind kind = RecordKind::automatic;  ///< as given, or found; never automatic in a result
    int samples = 0;
    double sample_time = 0;  ///< median spacing
    bool irregular = false;
    double noise_std = 0;                 ///< of y, high-frequency part
    double quantisation = 0;              ///< step of y's grid, 0 if none found
    int steps = 0;                        ///< moves of u
    std::vector<double> move_times = {};  ///< of the first 20 of them
    std::optional<int> cycles;            ///< for a relay test: complete periods of u
    bool settled = false;
    int samples_dropped = 0;                        ///< rows whose y is not used
    double u0 = 0, y0 = 0;                          ///< operating point: given, or before the first change of u
    std::optional<std::array<double, 2>> u_limits;  ///< limits of u that were applied: given, or found
    std::optional<PreTest> pretest;
    std::optional<MissingPart> gaps;     ///< spacings of more than five times the usual one
    std::optional<MissingPart> missing;  ///< rows without y; `longest` is the longest time from one y to the next
    int repeated_times = 0, backward_times = 0;
    bool time_unit_assumed = false;  ///< the unit of the times is not stated; the reader of the file sets this
    std::vector<Saturation> saturation;
    std::optional<double> backlash;  ///< u after a change of direction that has no effect on y; empty: none found
    std::optional<FalseReadings> outliers;
    std::optional<ClosedLoop> closed_loop;
    std::vector<std::string> notes;
};

/// Model of a further measured input (Record::d), for feedforward.
struct DisturbanceModel {
    std::string name;
    Plant plant;  ///< a lag and a dead time (Fopdt); with 1/s (Ipdt) if the plant integrates
    std::map<std::string, double> standard_errors;  ///< K, T, L
    double share = 0;  ///< share of the variance of y due to u and the further inputs, 0 to 1
};

struct IdentifiedLoop;  // closed_loop/loop_record.h

struct IdentifiedModel {
    Plant plant;
    double fit_percent = 0;
    std::vector<Candidate> candidates;
    std::map<std::string, double> standard_errors;
    ParameterCovariance covariance;
    std::vector<Plant> alternatives;  ///< fits of other structures, less than 4 above it by Akaike's criterion
    std::vector<DisturbanceModel> disturbances;  ///< the further measured inputs that matter
    std::optional<LimitCycle> limit_cycle;       ///< for a relay test
    std::vector<FrequencyPoint> frequency_points;
    std::optional<UltimatePoint> ultimate_point;  ///< of the plant; empty if no P gain makes the loop oscillate
    std::string choice_reason;                    ///< the reason for this structure, one sentence
    FitTrace fit;
    std::optional<ExcitedBand> excited_band;
    std::optional<RegionFigures>
        region;  ///< for the best-ranked controller on the 95 % confidence region; tune() sets it
    DataQuality data_quality;
    std::vector<Warning> warnings;
    std::shared_ptr<const IdentifiedLoop> loop;  ///< empty: not identified as a loop
};

/// The plant whose free run, driven by the recorded u from rest at u0 (or the first u), is closest to y: least squares
/// over gain, time constants, continuous dead time and offset (output error: Ljung 1999, section 4.2). No resampling:
/// the response to the piecewise constant u is exact at every time stamp.
///
/// - Rows of equal time: the last u counts from that time on, each y is data. Rows out of order or without numbers are
///   dropped; u of a row whose y is not a number counts.
/// - `u0`: u stepped from u0 to its first value at the first sample. Without it a start that is not at rest is
///   recognised if the record shows it, and noted. `y0` is weighted like ten samples of y at rest.
/// - `model` automatic fits every structure and keeps the one with the least information criterion, or the simpler one
///   if they are equal within noise. `fopdt` may have T < 0 (K is then negative too for 1/(s - 1)) for a record in
///   which u changes more than twice.
/// - Rows that are not small compared with the dead time show moves of u late (search/move_times.h): noted, and
/// included
///   in the standard error of L.
/// - A drift, a lasting load, or a backlash between u and the plant (search/play.h) is fitted with the model if the
/// record
///   shows it, and reported as a warning.
/// - Further measured inputs (Record::d) are identified with the plant, each with its own gain, lag and dead time
///   (further_inputs/further_inputs.h); one that explains nothing is omitted, and a note names it.
/// - A relay test also gives `limit_cycle`, `frequency_points`; if no structure fits it, the model is constrained to
///   the measured response at the oscillation (and to the static gain of a biased test), and a warning says so.
/// - `method` relay_fourier: Liu and Gao's formulas alone; two_point: the construction from one settled step. Neither
///   gives standard errors.
/// - Standard errors and covariance count correlated residuals as their number of independent samples, and include the
///   effect of rounding of y.
/// - If a controller moves u in response to y, the model is based on the effect of the set point's moves (column r, or
///   clear kicks of u) on u and y (closed_loop.h); without any, on its rows in manual (closed_loop/loop_parts.h);
///   without these either, the record is refused. Warning closed-loop.
/// - `fit` has at most 2,000 points; of more than 20,000 samples means over blocks are fitted, if the plant is slow
///   compared with them; of more than 100,000 always. Warning codes: diagnosis.h, model_answer.cpp, data_quality.h.
///
/// Progress runs from 0 to 1 with stage "identify". Errors: not_identifiable with the cure (fewer than 8 samples, u or
/// y constant, no response, a step in the last samples, fewer than two cycles for relay_fourier); invalid_argument
/// (columns of unequal length, times out of order, a shift that is not above 0); unsupported (a model that the method's
/// formulas do not give); cancelled.
Expected<IdentifiedModel> identify(const Record& record, const IdentifyOptions& options, const RunControl& control);

}  // namespace tunewright
