#include "engine/identification/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/identification/data_quality.h"
#include "engine/identification/starting_values.h"
#include "engine/identification/uncertainty.h"
#include "engine/identification/wording.h"

namespace tunewright {
namespace {

constexpr int kValleysRefined = 2;  // of the scan; twice as many with a zero, whose sign parts them
constexpr int kStartsRefined = 2;   // from simpler fits
constexpr int kThinSamples = 160;
constexpr Effort kCoarse{15, 1e-4};
constexpr Effort kComparison{60, 1e-7};
/// From the optimum on fewer samples: where noise is left, what remains after one step is of second order.
constexpr Effort kOneStep{4, 1e-2};
constexpr Effort kFinal{60, 1e-11};

Fit best_from(const FitData& data, const ModelForm& form, const std::vector<Shape>& starts, const Effort& effort,
              std::stop_token stop) {
    Fit best;
    best.form = form;
    bool first = true;
    for (const Shape& start : starts) {
        Fit fit = fit_shape(data, form, start, effort, stop);
        if (first || (fit.determined && (!best.determined || fit.sse < best.sse))) best = std::move(fit);
        first = false;
    }
    return best;
}

std::vector<Shape> most_promising(const FitContext& context, const ModelForm& form, const std::vector<Shape>& starts) {
    const std::vector<double> sums = sums_of_squares(context.few(), form, starts, context.stop);
    std::vector<int> order(starts.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return sums[a] < sums[b]; });
    std::vector<Shape> best;
    for (int i : order) {
        if (static_cast<int>(best.size()) < kStartsRefined) best.push_back(starts[i]);
    }
    return best;
}

bool same_form(const ModelForm& a, const ModelForm& b) {
    return a.other_level == b.other_level && a.load == b.load && (a.slope == b.slope || is_integrating(a.structure));
}

Fit fit_form(const FitContext& context, const ModelForm& form, const std::vector<Fit>& simpler) {
    std::vector<Shape> nested, extended;
    for (const Fit& fit : simpler) {
        const std::vector<Shape> shapes = extend_shape(fit.shape, form.structure);
        if (!shapes.empty() && same_form(fit.form, form)) nested.push_back(shapes.front());
        extended.insert(extended.end(), shapes.begin(), shapes.end());
    }
    // Of either kind: the simpler fits' neighbourhood looks good from the start, another valley only once refined.
    std::vector<Shape> starts = scan_shapes(context.few(), form, kValleysRefined * form.gains(), context.stop);
    if (!extended.empty()) {
        const std::vector<Shape> best = most_promising(context, form, extended);
        starts.insert(starts.end(), best.begin(), best.end());
    }
    Fit fit = best_from(context.few(), form, starts, kCoarse, context.stop);
    fit = fit_shape(context.some(), form, fit.shape, kComparison, context.stop);
    const bool worse = std::any_of(simpler.begin(), simpler.end(), [&](const Fit& s) {
        return same_form(s.form, form) && !extend_shape(s.shape, form.structure).empty() && fit.sse > s.sse;
    });
    if (worse && !nested.empty()) {
        Fit again = best_from(context.some(), form, nested, kComparison, context.stop);
        if (again.sse < fit.sse) fit = std::move(again);
    }
    return fit;
}

/// Differences of the criterion (Kass and Raftery 1995, section 3.2).
constexpr double kWorthAMention = 2, kStrong = 10, kRuledOut = 1e6;

/// The slope of an integrator at rest can be told from its response if the record shows y before u moves, or u moving
/// again.
bool shows_rest(const CleanRecord& r) {
    const auto before = std::count_if(r.t.begin(), r.t.end(), [&](double t) { return t <= r.v_time.front(); });
    return r.changes() > 1 || before >= 4;
}

/// A level of rest far from what u did is no level of rest: the structure is wrong, and the start stands in for another
/// lag.
bool plausible_rest(const CleanRecord& r, const Fit& fit) {
    const double rest = level_of_rest(fit);
    if (r.changes() == 1) return std::abs(rest) <= (is_integrating(fit.form.structure) ? 0.5 : 2.0);
    const auto [low, high] = std::minmax_element(r.v_level.begin(), r.v_level.end());
    const double span = std::max(0.0, *high) - std::min(0.0, *low);
    return rest >= std::min(0.0, *low) - span && rest <= std::max(0.0, *high) + span;
}

/// Whether the record contradicts an unseen step at its first sample: y stays within the noise until u first moves, for
/// longer than the dead time.
bool seen_at_rest(const CleanRecord& r, double L, double noise) {
    const double until = r.v_time.front();
    int n = 0;
    double sum = 0, squares = 0;
    for (; n < r.samples() && r.t[n] <= until; ++n) {
        sum += r.y[n];
        squares += r.y[n] * r.y[n];
    }
    if (n < 5 || until <= L) return false;
    const double mean = sum / n, spread = std::sqrt(std::max(0.0, squares / n - mean * mean));
    return spread <= std::max(2 * noise, 0.01);
}

bool starts_in_relay(const FitContext& context) {
    const CleanRecord& r = context.record;
    return context.relay && !r.u0_given && r.changes() > 1 &&
           std::any_of(r.v_level.begin(), r.v_level.end(), [](double v) { return v == 0; });
}

/// Where the fit from rest leaves more than noise behind, and the user has not said where u was before: the starts that
/// could explain it. A single change at the first sample is the unseen step itself.
std::vector<ModelForm> other_starts(const FitContext& context, const Fit& from_rest) {
    const CleanRecord& r = context.record;
    std::vector<ModelForm> starts;
    if (r.u0_given) return starts;
    ModelForm form = from_rest.form;
    if (is_integrating(form.structure) && !form.slope && shows_rest(r)) {
        form.slope = true;
        starts.push_back(form);
        form = from_rest.form;
    }
    form.other_level = true;
    if (leaves_a_pattern(context, from_rest) && !(r.changes() == 1 && r.v_time[0] == 0)) starts.push_back(form);
    return starts;
}

/// The residual variance below which fits count as equal, relative to y's range squared: rounding in the record's last
/// digits.
constexpr double kVarianceFloor = 1e-14;

}  // namespace

FitContext fit_context(CleanRecord record, bool relay, std::stop_token stop) {
    FitContext context;
    context.grid = quantisation_step(record.y);
    context.noise = std::max(noise_std(record.y), context.grid / std::sqrt(12.0));
    context.thin = thin_out(record, kThinSamples);
    context.medium = every_few(record, kMediumSamples);
    context.record = std::move(record);
    context.relay = relay;
    context.stop = stop;
    return context;
}

bool leaves_a_pattern(const FitContext& context, const Fit& fit) {
    const double n = static_cast<double>(fit.residual.size());
    return fit.sse > 2 * n * context.noise * context.noise && correlation_time(fit.residual) > 3;
}

Fit fit_structure(const FitContext& context, Structure structure, const Disturbances& disturbances,
                  const std::vector<Fit>& simpler) {
    const CleanRecord& record = context.record;
    ModelForm form{structure, false, disturbances.slope, disturbances.load};
    // A start that the simplest self-regulating structure needed, its extensions need too.
    const auto fopdt =
        std::find_if(simpler.begin(), simpler.end(), [](const Fit& f) { return f.form.structure == Structure::fopdt; });
    const bool known_start = fopdt != simpler.end() && fopdt->form.other_level && !is_integrating(structure);
    if (known_start || (starts_in_relay(context) && !is_integrating(structure))) {
        ModelForm left = form;
        left.other_level = true;
        Fit fit = fit_form(context, left, simpler);
        if (fit.determined && plausible_rest(record, fit)) return fit;
    }
    Fit best = fit_form(context, form, simpler);
    if (known_start) return best;
    for (const ModelForm& start : other_starts(context, best)) {
        Fit fit = fit_form(context, start, simpler);
        if (!fit.determined || !plausible_rest(record, fit)) continue;
        if (start.other_level && seen_at_rest(record, fit.shape.L(), context.noise)) continue;
        const double n = effective_samples(fit.residual);
        if (information_criterion(fit, n) + kStrong < information_criterion(best, n)) best = std::move(fit);
    }
    return best;
}

void polish(const FitContext& context, Fit& fit) {
    Fit again = fit_shape(context.all(), fit.form, fit.shape, kFinal, context.stop);
    if (again.determined && again.sse <= fit.sse) fit = std::move(again);
}

void finish_fits(const FitContext& context, std::vector<Fit>& fits) {
    if (context.record.samples() == context.medium.samples()) return;
    double best = std::numeric_limits<double>::max();
    for (Fit& fit : fits) {
        const bool determined = fit.determined;
        fit = project(context.all(), fit.form, fit.shape);
        fit.determined = fit.determined && determined;
        if (fit.determined) best = std::min(best, fit.sse);
    }
    // What the errors of the parameters from fewer samples can cost, several times over.
    const double n = context.record.samples();
    const double noise = best / n + kVarianceFloor;
    const double reach = 100 * noise * n / context.medium.samples();
    for (Fit& fit : fits) {
        if (fit.determined && fit.sse < best * 1.02 + reach)
            fit = fit_shape(context.all(), fit.form, fit.shape, kOneStep, context.stop);
    }
}

double level_of_rest(const Fit& fit) {
    if (fit.form.other_level) return -fit.linear[fit.form.level_index()] / fit.linear[0];
    if (is_integrating(fit.form.structure) && fit.form.slope)
        return -fit.linear[fit.form.slope_index()] / fit.linear[0];
    return 0;
}

double information_criterion(const Fit& fit, double independent_samples) {
    const double variance = fit.sse / static_cast<double>(fit.residual.size()) + kVarianceFloor;
    return independent_samples * std::log(variance) + fit.form.parameters() * std::log(independent_samples);
}

double fit_percent(const CleanRecord& record, const Fit& fit) {
    const double mean = std::accumulate(record.y.begin(), record.y.end(), 0.0) / record.samples();
    double total = 0, left = 0;
    for (int i = 0; i < record.samples(); ++i) {
        total += (record.y[i] - mean) * (record.y[i] - mean);
        left += fit.residual[i] * fit.residual[i];
    }
    return 100 * (1 - std::sqrt(left / total));
}

/// A lag of ten record lengths and more (two, where it is unstable) cannot be told from an integrator, nor its gain
/// from any other.
bool looks_integrating(const Fit& fit) {
    const Structure structure = fit.form.structure;
    if (structure == Structure::fopdt) return fit.shape.T() > 10;
    if (structure == Structure::unstable) return fit.shape.T() > 2;
    return (structure == Structure::sopdt || structure == Structure::sopdt_zero) && fit.shape.a1() > 10;
}

Choice choose(const std::vector<Fit>& fits, const std::vector<double>& criteria, const std::vector<double>& percents,
              double independent_samples) {
    // A handicap makes "must win by" a comparison like any other.
    auto handicapped = [&](int i) {
        const bool unusual = fits[i].form.structure == Structure::sopdt_zero ||
                             fits[i].form.structure == Structure::unstable || fits[i].form.other_level;
        return criteria[i] + (unusual ? kStrong - kWorthAMention : 0) + (looks_integrating(fits[i]) ? kRuledOut : 0);
    };
    int best = -1;
    for (int i = 0; i < static_cast<int>(fits.size()); ++i) {
        if (fits[i].determined && (best < 0 || handicapped(i) < handicapped(best))) best = i;
    }
    if (best < 0) return {-1, ""};
    int chosen = best;
    for (int i = 0; i < static_cast<int>(fits.size()); ++i) {
        if (fits[i].determined && fits[i].form.parameters() < fits[chosen].form.parameters() &&
            handicapped(i) < handicapped(best) + kWorthAMention)
            chosen = i;
    }
    int rival = -1;
    for (int i = 0; i < static_cast<int>(fits.size()); ++i) {
        if (i != chosen && fits[i].determined && (rival < 0 || criteria[i] < criteria[rival])) rival = i;
    }
    std::string reason = name_of(fits[chosen].form.structure);
    if (rival < 0) return {chosen, reason + ": the only structure that this record determines."};
    const std::string other = name_of(fits[rival].form.structure);
    const std::string figures =
        "fit " + number_text(percents[chosen]) + " % against " + number_text(percents[rival]) + " % of " + other;
    const double lead = criteria[rival] - criteria[chosen];
    if (lead >= 0) {
        reason += ": the best balance of fit and number of parameters (" + figures +
                  "; information criterion lower by " + number_text(lead, 3) + " with " +
                  number_text(independent_samples, 3) + " independent samples).";
    } else {
        reason += ": the simpler structure; " + other + " fits no better beyond what noise explains (" + figures +
                  "; information criterion within " + number_text(-lead, 3) + ").";
    }
    return {chosen, reason};
}

}  // namespace tunewright
