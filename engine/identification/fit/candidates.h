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

/// What the fits of one record share. `thin` has a few hundred samples for scans, `medium` at most kMediumSamples for
/// the structures' comparison.
struct FitContext {
    CleanRecord record, medium, thin;
    double noise = 0;    ///< standard deviation of what changes from sample to sample, rounding included
    double grid = 0;     ///< step that y is rounded to, 0 if none
    bool relay = false;  ///< a relay test
    RecordStart start = RecordStart::at_rest;
    std::vector<FrequencyConstraint> anchors;  ///< that every model is held to
    std::stop_token stop;
    ParallelFor spread = {};  ///< of fits that do not need one another

    FitData all() const { return {&record, anchors}; }
    FitData some() const { return {&medium, anchors}; }
    FitData few() const { return {&thin, anchors}; }
};

inline constexpr int kMediumSamples = 600;

FitContext fit_context(CleanRecord record, bool relay, const RunControl& control);

/// What else than u moved y, and is looked for in every structure.
struct Disturbances {
    bool slope = false, load = false;
};

/// Fits one structure to the medium record: scan and refinement of the best starts on the thin one, final fit there.
/// `simpler` are fits of the structures that it contains; it never ends worse than they do. A start other than rest is
/// fitted where the record does not show rest: kept where y moves before u does if it lowers the criterion, where
/// nothing is seen before u moves if it lowers it by 6, and beside a drift by 10.
Fit fit_structure(const FitContext& context, Structure structure, const Disturbances& disturbances,
                  const std::vector<Fit>& simpler);

/// How many structures lie between this one and the simplest that its starting values come from: structures of one
/// depth do not need one another's fits.
int depth(Structure structure);

/// The structures of one depth, or of the deepest, fitted at once as fit_structure() does each.
std::vector<Fit> fit_structures(const FitContext& context, const std::vector<Structure>& structures,
                                const Disturbances& disturbances, const std::vector<Fit>& simpler);

/// The same fits on the whole record; those that cannot be chosen any more keep their parameters.
void finish_fits(const FitContext& context, std::vector<Fit>& fits);

/// The chosen one to its last digit.
void polish(const FitContext& context, Fit& fit);

/// The best-fitting candidate, whose residual is the nearest to noise; null where none is determined.
const Fit* best_fit(const std::vector<Fit>& fits);

/// y's noise, known to some ten per cent; a y of a few levels is no noise of that size. An oscillation of a few rows a
/// period looks like noise from row to row: what the `best` model leaves, null where there is none, says that it is
/// less.
double known_noise(const FitContext& context, const Fit* best);

/// Whether a fit leaves more than noise behind, and in a pattern.
bool leaves_a_pattern(const FitContext& context, const Fit& fit);

/// True if an unstable model's time constant is about the least that a record can show, e^kMinUnstable of its length.
bool at_shortest_lag(const Fit& fit);

/// sqrt((||residual||^2 - n (1.1 noise)^2)/||y - mean(y)||^2), at least 0: what a fit leaves beyond noise, as a share
/// of y's standard deviation. `fit` is of all samples of context.record.
double unexplained_share(const FitContext& context, const Fit& fit);

/// n ln(sse/n) + p ln n (Schwarz 1978) with n the number of independent samples that the residuals are worth, in place
/// of their count: what a drift or a coarse grid leaves behind is not evidence for another time constant. Nor is what
/// lies below `min_variance`, where that is known of the noise.
double information_criterion(const Fit& fit, double independent_samples, double min_variance = 0);

/// True if a late load, or a drift, can be distinguished from the response: if u moves again; a drift also by what y
/// does before u moves.
bool shows_load(const CleanRecord& record);
bool shows_drift(const CleanRecord& record);

/// A load far beyond all that u did stands in for the plant's own response, and so does one that takes back a move of u
/// before the plant has answered it: then the move and its answer belong to different moves. True without a load.
bool plausible_load(const CleanRecord& record, const Fit& fit);

struct StructureChoice {
    int index = -1;  ///< into the fits; -1: none is determined
    std::string reason;
};

/// A lag of ten record lengths and more (two, where it is unstable) cannot be distinguished from an integrator, nor its
/// gain from any other.
bool looks_integrating(const Fit& fit);

/// Among determined fits: the least criterion, unless a structure with fewer parameters comes within 5 of it (within 10
/// of one with a zero, an unseen start or an unstable pole) and its fit, too, lies within what noise explains: a
/// hundredth of y's deviation, and up to three more for what so few more parameters take up of noise as strong as the
/// best fit's residual (95 % of an F distribution). `criteria` and `fit_percent` belong to `fits`.
StructureChoice choose(const std::vector<Fit>& fits, const std::vector<double>& criteria,
                       const std::vector<double>& fit_percent, double independent_samples);

/// The level of v at which y was at rest before the record; 0 where the form has no other.
double level_of_rest(const Fit& fit);

/// 100 (1 - ||residual||/||y - mean(y)||).
double fit_percent(const CleanRecord& record, const Fit& fit);

}  // namespace tunewright
