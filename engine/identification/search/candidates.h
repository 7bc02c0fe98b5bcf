// The structures fitted to one record, and the choice among them.
#pragma once

#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/fit/output_error.h"
#include "engine/identification/identify.h"
#include "engine/identification/record/record_kind.h"
#include "engine/progress.h"

namespace tunewright {

/// The data that the fits of one record share. `thin` has a few hundred samples for scans, `medium` at most
/// kMediumSamples for the comparison of structures.
struct FitContext {
    CleanRecord record, medium, thin;
    double noise = 0;    ///< standard deviation of the changes from sample to sample, with rounding
    double grid = 0;     ///< step of y's rounding, 0 if none
    bool relay = false;  ///< true: a relay test
    int gain_sign = 0;   ///< of the static gain with which the relay oscillates; 0: not known
    RecordStart start = RecordStart::at_rest;
    std::vector<FrequencyConstraint> anchors;  ///< measured values that every model must fit
    std::stop_token stop;
    ParallelFor spread = {};  ///< for fits that do not depend on each other

    FitData all() const { return {&record, anchors}; }
    FitData some() const { return {&medium, anchors}; }
    FitData few() const { return {&thin, anchors}; }
};

inline constexpr int kMediumSamples = 600;

FitContext fit_context(CleanRecord record, bool relay, const RunControl& control);

/// Causes of movements of y other than u, which are fitted in every structure.
struct Disturbances {
    bool slope = false, load = false;
};

/// Fits one structure to the medium record: scan and refinement of the best starts on the thin one, final fit there.
/// `simpler` are fits of the structures that it contains; it never ends worse than they do. A start other than rest is
/// fitted if the record does not show rest. It is kept if it lowers the criterion and y moves before u; if nothing is
/// recorded before u moves it must lower it by 6, in addition to a drift by 10.
Fit fit_structure(const FitContext& context, Structure structure, const Disturbances& disturbances,
                  const std::vector<Fit>& simpler);

/// Number of structures between this one and the simplest that its starting values come from: structures of the same
/// depth do not depend on each other.
int depth(Structure structure);

/// The structures of one depth, or of the deepest, fitted at the same time by fit_structure().
std::vector<Fit> fit_structures(const FitContext& context, const std::vector<Structure>& structures,
                                const Disturbances& disturbances, const std::vector<Fit>& simpler);

/// The same fits on the whole record; those that can no longer be chosen keep their parameters.
void finish_fits(const FitContext& context, std::vector<Fit>& fits);

/// Refines the chosen fit to its last digit.
void polish(const FitContext& context, Fit& fit);

/// The best-fitting candidate, whose residual is closest to noise; null if none is determined.
const Fit* best_fit(const std::vector<Fit>& fits);

/// Noise of y, with an uncertainty of about ten per cent; if y has only a few levels, their step is not noise of that
/// size. An oscillation with few rows per period looks like noise from row to row: the residual of the `best` model
/// (null if there is none) is an upper bound.
double known_noise(const FitContext& context, const Fit* best);

/// True if a fit leaves more than noise, and with a pattern.
bool leaves_a_pattern(const FitContext& context, const Fit& fit);

/// True if an unstable model's time constant is about the least that a record can show, e^kMinUnstable of its length.
bool at_shortest_lag(const Fit& fit);

/// sqrt((||residual||^2 - n (1.1 noise)^2)/||y - mean(y)||^2), at least 0: the residual beyond noise, as a share of y's
/// standard deviation. `fit` must be of all samples of context.record.
double unexplained_share(const FitContext& context, const Fit& fit);

/// n ln(sse/n) + p ln n (Schwarz 1978) with n the number of independent samples in the residuals, not their count: the
/// residual of a drift or a coarse grid is no evidence for another time constant. Neither is a residual variance below
/// `min_variance`, the known noise.
double information_criterion(const Fit& fit, double independent_samples, double min_variance = 0);

/// True if a late load, or a drift, can be distinguished from the response: if u moves again; a drift also by the
/// movement of y before u moves.
bool shows_load(const CleanRecord& record);
bool shows_drift(const CleanRecord& record);

/// False if the load is much larger than the range of u, or if it cancels a move of u before the plant has responded to
/// it: such a load replaces the plant's own response. True without a load.
bool plausible_load(const CleanRecord& record, const Fit& fit);

/// Size of the load of `fit` over that of the move of u, one of the first two, in whose response it begins: the record
/// does not show then whether the moves have different effects instead, as behind a backlash or with a gain that
/// varies. 0 without such a move.
double load_over_move(const CleanRecord& record, const Fit& fit);

struct StructureChoice {
    int index = -1;  ///< index of the fit; -1: none is determined
    std::string reason;
};

/// A lag of ten record lengths or more (two if it is unstable) cannot be distinguished from an integrator, and its gain
/// cannot be determined.
bool is_nearly_integrating(const Fit& fit);

/// Among determined fits: the least criterion, unless a structure with fewer parameters comes within 5 of it (within 10
/// of one with a zero, an unseen start or an unstable pole) and the difference of the fits is explained by noise: a
/// hundredth of y's deviation, and up to three more for the noise that the additional parameters fit, with the strength
/// of the best fit's residual (95 % of an F distribution). `criteria` and `fit_percent` belong to `fits`.
StructureChoice choose(const std::vector<Fit>& fits, const std::vector<double>& criteria,
                       const std::vector<double>& fit_percent, double independent_samples);

/// The level of v at which y was at rest before the record; 0 if the form has no other level.
double level_of_rest(const Fit& fit);

/// 100 (1 - ||residual||/||y - mean(y)||).
double fit_percent(const CleanRecord& record, const Fit& fit);

}  // namespace tunewright
