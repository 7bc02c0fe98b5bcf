#include "engine/identification/search/candidates.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

#include "engine/identification/fit/residual_noise.h"
#include "engine/identification/fit/starting_values.h"
#include "engine/identification/record/series.h"
#include "engine/identification/relay_test/recorded_cycle.h"
#include "engine/number_text.h"

namespace tunewright {
namespace {

constexpr int kValleysRefined = 2;  ///< local minima of the scan; twice as many with a zero, whose two signs give
                                    ///< separate ones
constexpr int kStartsRefined = 2;   ///< starts that come from simpler fits
constexpr int kThinSamples = 160;   ///< samples that are enough to rank starts
constexpr Effort kCoarseEffort{15, 1e-4};
constexpr Effort kComparisonEffort{60, 1e-7};
/// From the optimum on fewer samples: with noise in the residual, the remaining error after one step is of second
/// order.
constexpr Effort kOneStepEffort{4, 1e-2};
constexpr Effort kFinalEffort{60, 1e-11};

Fit best_from(const FitContext& context, const FitData& data, const ModelForm& form,
              const std::vector<ModelShape>& starts, const Effort& effort) {
    Fit best;
    best.form = form;
    std::vector<Fit> fits(starts.size());
    parallel_for(context.spread, static_cast<int>(starts.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        fits[at] = fit_shape(data, form, starts[at], effort, context.stop);
    });
    for (Fit& fit : fits)
        if (&fit == &fits.front() || (fit.determined && (!best.determined || fit.sse < best.sse)))
            best = std::move(fit);
    return best;
}

std::vector<ModelShape> best_points(const FitContext& context, const ModelForm& form,
                                    const std::vector<ModelShape>& starts) {
    const std::vector<double> sums = sums_of_squares(context.few(), form, starts, context.stop);
    std::vector<int> order(starts.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return sums[a] < sums[b]; });
    std::vector<ModelShape> best;
    for (int i : order) {
        if (static_cast<int>(best.size()) < kStartsRefined) best.push_back(starts[i]);
    }
    return best;
}

bool same_form(const ModelForm& a, const ModelForm& b) {
    return a.other_level == b.other_level && a.load == b.load && (a.slope == b.slope || is_integrating(a.structure));
}

/// Adds a slow part to the one lag of a simpler fit. A relay's oscillation hardly shows it, so the scan does not find
/// it.
void add_slow_parts(const ModelShape& simpler, std::vector<ModelShape>& starts) {
    if (simpler.structure != Structure::fopdt) return;
    for (const double times : {5.0, 20.0}) {
        ModelShape shape = simpler;
        shape.structure = Structure::sopdt_zero;
        shape.p[1] = simpler.p[1] + std::log(1 + times);
        shape.p[2] = std::log(times / ((1 + times) * (1 + times)));
        starts.push_back(shape);
    }
}

Fit fit_form(const FitContext& context, const ModelForm& form, const std::vector<Fit>& simpler) {
    std::vector<ModelShape> nested, extended;
    for (const Fit& fit : simpler) {
        const std::vector<ModelShape> shapes = extend_shape(fit.shape, form.structure);
        if (!shapes.empty() && same_form(fit.form, form)) nested.push_back(shapes.front());
        extended.insert(extended.end(), shapes.begin(), shapes.end());
        if (context.relay && form.structure == Structure::sopdt_zero) add_slow_parts(fit.shape, extended);
    }
    // Starts of both kinds: one near a simpler fit looks good at once, another local minimum only after refinement.
    std::vector<ModelShape> starts = scan_shapes(context.few(), form, kValleysRefined * form.gains(), context.stop);
    if (!extended.empty()) {
        const std::vector<ModelShape> best = best_points(context, form, extended);
        starts.insert(starts.end(), best.begin(), best.end());
    }
    Fit fit = best_from(context, context.few(), form, starts, kCoarseEffort);
    fit = fit_shape(context.some(), form, fit.shape, kComparisonEffort, context.stop);
    const bool worse = std::any_of(simpler.begin(), simpler.end(), [&](const Fit& s) {
        return same_form(s.form, form) && !extend_shape(s.shape, form.structure).empty() && fit.sse > s.sse;
    });
    if (worse && !nested.empty()) {
        Fit again = best_from(context, context.some(), form, nested, kComparisonEffort);
        if (again.sse < fit.sse) fit = std::move(again);
    }
    return fit;
}

/// differences of the criterion (Kass and Raftery 1995, section 3.2)
constexpr double kMinEvidenceOverSimpler = 5, kPositiveEvidence = 6, kStrongEvidence = 10, kOverwhelmingEvidence = 50;

/// The slope of an integrator at rest can be distinguished from its response if the record shows y before u moves, or u
/// moving again.
bool shows_rest(const CleanRecord& r) {
    constexpr int kMinSamplesBefore = 4;  // samples that distinguish a slope from noise
    const auto before = std::count_if(r.t.begin(), r.t.end(), [&](double t) { return t <= r.v_time.front(); });
    return r.changes() > 1 || before >= kMinSamplesBefore;
}

/// A level of rest far from the range of u is not plausible: the structure is wrong, and the start replaces another
/// lag.
bool plausible_rest(const CleanRecord& r, const Fit& fit) {
    const double rest = level_of_rest(fit);
    constexpr double kMaxRestInSteps = 2, kMaxRestInStepsIntegrating = 0.5;  // in steps of u
    if (r.changes() == 1)
        return std::abs(rest) <= (is_integrating(fit.form.structure) ? kMaxRestInStepsIntegrating : kMaxRestInSteps);
    const auto [low, high] = std::minmax_element(r.v_level.begin(), r.v_level.end());
    const double span = std::max(0.0, *high) - std::min(0.0, *low);
    return rest >= std::min(0.0, *low) - span && rest <= std::max(0.0, *high) + span;
}

/// True for a relay that works from the first row: no part of the record is at rest.
bool starts_in_relay(const FitContext& context) {
    const CleanRecord& r = context.record;
    return context.relay && context.start == RecordStart::unseen &&
           std::any_of(r.v_level.begin(), r.v_level.end(), [](double v) { return v == 0; });
}

/// The starts other than rest that are possible for this structure in the record.
std::vector<ModelForm> other_starts(const FitContext& context, const Fit& from_rest) {
    if (context.start == RecordStart::at_rest) return {};
    std::vector<ModelForm> starts;
    ModelForm form = from_rest.form;
    if (is_integrating(form.structure) && !form.slope && shows_rest(context.record)) {
        form.slope = true;
        starts.push_back(form);
        form = from_rest.form;
    }
    form.other_level = true;
    if (context.start == RecordStart::moving || leaves_a_pattern(context, from_rest)) starts.push_back(form);
    return starts;
}

}  // namespace

/// y of a relay moves against u, or with it if the gain is negative; about halfway between, it was moved by something
/// else.
static int gain_sign(const FitContext& context) {
    constexpr double kLeastCosine = 0.5;
    const auto cycle = find_cycle(context.record, context.noise);
    if (!cycle) return 0;
    const std::complex<double> G = cycle->harmonics.front().G;
    return G.real() < -kLeastCosine * std::abs(G) ? 1 : G.real() > kLeastCosine * std::abs(G) ? -1 : 0;
}

FitContext fit_context(CleanRecord record, bool relay, const RunControl& control) {
    FitContext context;
    context.grid = quantisation_step(record.y);
    context.noise = std::max(noise_std(record.y), context.grid / std::sqrt(12.0));
    context.thin = thin_out(record, kThinSamples);
    context.medium = every_few(record, kMediumSamples);
    context.record = std::move(record);
    context.start = start_of(context.record, relay, context.noise);
    context.relay = relay;
    if (relay) context.gain_sign = gain_sign(context);
    context.stop = control.stop;
    context.spread = control.spread;
    return context;
}

bool leaves_a_pattern(const FitContext& context, const Fit& fit) {
    const auto n = static_cast<double>(fit.residual.size());
    constexpr double kMinNoiseVariances = 2,
                     kMinCorrelationTime = 3;  // multiple of the noise's variance; samples of correlation time
    return fit.sse > kMinNoiseVariances * n * context.noise * context.noise &&
           correlation_time(fit.residual) > kMinCorrelationTime;
}

const Fit* best_fit(const std::vector<Fit>& fits) {
    const Fit* best = nullptr;
    for (const Fit& fit : fits) {
        if (fit.determined && (best == nullptr || fit.sse < best->sse)) best = &fit;
    }
    return best;
}

double known_noise(const FitContext& context, const Fit* best) {
    constexpr double kMaxNoise = 0.03;
    double noise = context.noise;
    if (context.relay && best != nullptr)
        noise = std::clamp(std::sqrt(innovation_variance(best->residual)), context.grid / std::sqrt(12.0), noise);
    return std::min(noise, kMaxNoise);
}

bool at_shortest_lag(const Fit& fit) {
    constexpr double kMaxLogBoundDistance = 0.2;  // of ln T: the search ended at the bound, or one step of its scan
                                                  // before it
    return fit.form.structure == Structure::unstable && fit.shape.p[1] <= kMinUnstable + kMaxLogBoundDistance;
}

double unexplained_share(const FitContext& context, const Fit& fit) {
    constexpr double kNoiseKnownTo = 1.1;  // uncertainty of the noise: about ten per cent
    double left = 0;
    for (const double e : fit.residual) left += e * e;
    const double noise = kNoiseKnownTo * context.noise, n = context.record.samples();
    return std::sqrt(std::max(0.0, left - n * noise * noise) / squares_about_mean(context.record.y));
}

Fit fit_structure(const FitContext& context, Structure structure, const Disturbances& disturbances,
                  const std::vector<Fit>& simpler) {
    const CleanRecord& record = context.record;
    const ModelForm form{structure, false, disturbances.slope, disturbances.load};
    // A start that the simplest self-regulating structure needs is needed by its extensions too.
    const auto fopdt =
        std::find_if(simpler.begin(), simpler.end(), [](const Fit& f) { return f.form.structure == Structure::fopdt; });
    const bool known_start = fopdt != simpler.end() && fopdt->form.other_level && !is_integrating(structure);
    const bool left_rest = starts_in_relay(context) || record.moved_at_first_row;
    if (known_start || (left_rest && !is_integrating(structure))) {
        ModelForm left = form;
        left.other_level = true;
        Fit fit = fit_form(context, left, simpler);
        if (fit.determined && plausible_rest(record, fit)) return fit;
    }
    Fit best = fit_form(context, form, simpler);
    if (known_start) return best;
    // A movement before that of u is a start or a drift: in addition to a drift a start must be significant by itself.
    const double lead = disturbances.slope                     ? kStrongEvidence
                        : context.start == RecordStart::moving ? 0
                                                               : kPositiveEvidence;
    for (const ModelForm& start : other_starts(context, best)) {
        Fit fit = fit_form(context, start, simpler);
        if (!fit.determined || !plausible_rest(record, fit)) continue;
        const double n = effective_samples(fit.residual);
        if (information_criterion(fit, n) + lead < information_criterion(best, n)) best = std::move(fit);
    }
    return best;
}

int depth(Structure structure) {
    switch (structure) {
        case Structure::ipdt:
        case Structure::fopdt: return 0;
        case Structure::ipdt_lag:
        case Structure::sopdt:
        case Structure::unstable: return 1;
        case Structure::sopdt_zero:
        case Structure::third:
        case Structure::ipdt_second: return 2;
    }
    return 0;
}

std::vector<Fit> fit_structures(const FitContext& context, const std::vector<Structure>& structures,
                                const Disturbances& disturbances, const std::vector<Fit>& simpler) {
    std::vector<Fit> fits(structures.size());
    parallel_for(context.spread, static_cast<int>(structures.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        fits[at] = fit_structure(context, structures[at], disturbances, simpler);
    });
    return fits;
}

void polish(const FitContext& context, Fit& fit) {
    Fit again = fit_shape(context.all(), fit.form, fit.shape, kFinalEffort, context.stop);
    if (again.determined && again.sse <= fit.sse) fit = std::move(again);
}

void finish_fits(const FitContext& context, std::vector<Fit>& fits) {
    if (context.record.samples() == context.medium.samples()) return;
    const auto each = [&](const std::function<void(Fit&)>& work) {
        parallel_for(context.spread, static_cast<int>(fits.size()),
                     [&](int i) { work(fits[static_cast<std::size_t>(i)]); });
    };
    each([&](Fit& fit) {
        const bool determined = fit.determined;
        fit = project(context.all(), fit.form, fit.shape);
        fit.determined = fit.determined && determined;
    });
    double best = std::numeric_limits<double>::max();
    for (const Fit& fit : fits)
        if (fit.determined) best = std::min(best, fit.sse);
    // Largest change of the criterion through the errors of parameters from fewer samples, with a margin.
    const double n = context.record.samples();
    const double noise = best / n + kVarianceFloor;
    constexpr double kSeveralTimes = 100, kNearBest = 1.02;
    const double reach = kSeveralTimes * noise * n / context.medium.samples();
    each([&](Fit& fit) {
        if (fit.determined && fit.sse < best * kNearBest + reach)
            fit = fit_shape(context.all(), fit.form, fit.shape, kOneStepEffort, context.stop);
    });
}

double level_of_rest(const Fit& fit) {
    if (fit.form.other_level) return -fit.linear[fit.form.level_index()] / fit.linear[0];
    if (is_integrating(fit.form.structure) && fit.form.slope)
        return -fit.linear[fit.form.slope_index()] / fit.linear[0];
    return 0;
}

double information_criterion(const Fit& fit, double independent_samples, double min_variance) {
    const double variance = std::max(fit.sse / static_cast<double>(fit.residual.size()), min_variance) + kVarianceFloor;
    return independent_samples * std::log(variance) + fit.form.parameters() * std::log(independent_samples);
}

double fit_percent(const CleanRecord& record, const Fit& fit) {
    double left = 0;
    for (const double e : fit.residual) left += e * e;
    return 100 * (1 - std::sqrt(left / squares_about_mean(record.y)));
}

bool is_nearly_integrating(const Fit& fit) {
    const Structure structure = fit.form.structure;
    constexpr double kWithoutEnd = 10, kWithoutEndUnstable = 2;  // record lengths
    if (structure == Structure::fopdt) return fit.shape.T() > kWithoutEnd;
    if (structure == Structure::unstable) return fit.shape.T() > kWithoutEndUnstable;
    if (structure == Structure::third && fit.shape.T3() > kWithoutEnd) return true;
    return has_quadratic(structure) && !is_integrating(structure) && fit.shape.a1() > kWithoutEnd;
}

/// Reduction of the residual's deviation by `more` additional parameters that only fit noise in `independent` samples,
/// as a factor: 95 % of an F distribution is about 4.
double by_noise(int more, double independent, int parameters) {
    constexpr double kFRatio = 4;
    return std::sqrt(1 + kFRatio * more / std::max(1.0, independent - parameters));
}

/// True if `simple` explains the record as well as `best`, except for noise.
bool as_good(const Fit& simple, const Fit& best, double lead, double points, double left, double independent) {
    const bool unusual = best.form.structure == Structure::sopdt_zero || best.form.structure == Structure::unstable ||
                         (best.form.other_level && !simple.form.other_level);
    const int more = best.form.parameters() - simple.form.parameters();
    constexpr double kMinPercentGain = 1, kMaxByNoise = 3;  // per cent of y's deviation
    const double taken_up = left * (by_noise(more, independent, best.form.parameters()) - 1);
    return more > 0 && lead < (unusual ? kStrongEvidence : kMinEvidenceOverSimpler) &&
           points < kMinPercentGain + std::min(kMaxByNoise, taken_up);
}

bool shows_load(const CleanRecord& r) { return r.changes() > 1; }

bool shows_drift(const CleanRecord& r) {
    constexpr int kMinSamplesBeforeStep = 15;
    const auto before = std::lower_bound(r.t.begin(), r.t.end(), r.v_time.front()) - r.t.begin();
    return r.changes() > 1 || before >= kMinSamplesBeforeStep;
}

bool plausible_load(const CleanRecord& r, const Fit& fit) {
    constexpr double kMaxLoadInRanges = 3,
                     kMaxLoadDifference = 0.4;  // ranges of u; relative difference between the load and a move
    if (!fit.form.load) return true;
    const double load = fit.linear[fit.form.load_index()] / fit.linear[0];
    if (!(std::abs(load) <= kMaxLoadInRanges)) return false;
    const double time = fit.shape.load_time(), row = usual_spacing(r);
    for (int j = 0; j < r.changes(); ++j) {
        const double move = r.v_level[j] - (j > 0 ? r.v_level[j - 1] : 0);
        const bool before_answer = time > r.v_time[j] - row && time < r.v_time[j] + fit.shape.L() + row;
        if (before_answer && std::abs(load + move) < kMaxLoadDifference * std::abs(move)) return false;
    }
    return true;
}

/// 0 for an integrator, in addition to which there may be a lag.
static double slow_lag(const ModelShape& shape) {
    if (shape.structure == Structure::ipdt) return 0;
    if (shape.structure == Structure::ipdt_second) return shape.a1();
    return shape.slowest_lag();
}

double load_over_move(const CleanRecord& r, const Fit& fit) {
    constexpr double kOfLag = 0.5;  // of the slowest lag: a load that begins so much later looks like another move
    constexpr double kRows = 2;
    constexpr int kFirstMoves = 2;  // later ones are compared with those before them
    if (!fit.form.load) return 0;
    const double load = std::abs(fit.linear[fit.form.load_index()] / fit.linear[0]), rows = kRows * usual_spacing(r),
                 time = fit.shape.load_time(), window = fit.shape.L() + kOfLag * slow_lag(fit.shape) + rows;
    double ratio = 0;
    for (int j = 0; j < std::min(kFirstMoves, r.changes()); ++j) {
        const double move = std::abs(r.v_level[j] - (j > 0 ? r.v_level[j - 1] : 0));
        if (move > 0 && time > r.v_time[j] - rows && time < r.v_time[j] + window) ratio = std::max(ratio, load / move);
    }
    return ratio;
}

std::string why_chosen(const std::vector<Fit>& fits, const std::vector<double>& criteria,
                       const std::vector<double>& percents, int chosen, double independent_samples) {
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    int rival = -1;
    for (int i = 0; i < static_cast<int>(fits.size()); ++i) {
        if (i != chosen && fits[at(i)].determined && (rival < 0 || criteria[at(i)] < criteria[at(rival)])) rival = i;
    }
    const std::string name = name_of(fits[at(chosen)].form.structure);
    if (rival < 0) return name + ": the only structure that this record determines.";
    const std::string other = name_of(fits[at(rival)].form.structure);
    const std::string figures =
        "fit " + text(percents[at(chosen)]) + " % against " + text(percents[at(rival)]) + " % of " + other;
    const double lead = criteria[at(rival)] - criteria[at(chosen)];
    if (lead < 0) {
        return name + ": the simpler structure; the amount that " + other + " gains is within what noise explains (" +
               figures + "; its information criterion is within " + text(-lead, 3) + ").";
    }
    return name + ": the best balance of fit and number of parameters (" + figures +
           "; its information criterion is lower by " + text(lead, 3) + " with " + figure_text(independent_samples) +
           " independent samples).";
}

StructureChoice choose(const std::vector<Fit>& fits, const std::vector<double>& criteria,
                       const std::vector<double>& percents, double independent_samples) {
    int best = -1, slowest = -1;  // `slowest` is the best of all, including infinite lags
    for (int i = 0; i < static_cast<int>(fits.size()); ++i) {
        if (!fits[i].determined) continue;
        if (slowest < 0 || criteria[i] < criteria[slowest]) slowest = i;
        if (!is_nearly_integrating(fits[i]) && (best < 0 || criteria[i] < criteria[best])) best = i;
    }
    // A model that looks like an integrator is replaced by an integrating structure, unless none of them explains the
    // record.
    if (best < 0 || criteria[slowest] + kOverwhelmingEvidence < criteria[best]) best = slowest;
    if (best < 0) return {-1, ""};
    int chosen = best;
    for (int i = 0; i < static_cast<int>(fits.size()); ++i) {
        if (!fits[i].determined || is_nearly_integrating(fits[i])) continue;
        const bool simpler =
            fits[i].form.parameters() < fits[chosen].form.parameters() ||
            (fits[i].form.parameters() == fits[chosen].form.parameters() && criteria[i] < criteria[chosen]);
        if (simpler && as_good(fits[i], fits[best], criteria[i] - criteria[best], percents[best] - percents[i],
                               100 - percents[best], independent_samples))
            chosen = i;
    }
    return {chosen, why_chosen(fits, criteria, percents, chosen, independent_samples)};
}

}  // namespace tunewright
