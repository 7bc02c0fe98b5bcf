#include "engine/identification/candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/identification/data_quality.h"
#include "engine/identification/starting_values.h"
#include "engine/identification/uncertainty.h"
#include "engine/identification/wording.h"

namespace tunewright {
namespace {

constexpr int kStartsRefined = 3;
constexpr int kCoarseIterations = 25;
constexpr int kFinalIterations = 60;

Fit best_from(const CleanRecord& record, const ModelForm& form, const std::vector<Shape>& starts, int iterations,
              std::stop_token stop) {
    Fit best;
    best.form = form;
    bool first = true;
    for (const Shape& start : starts) {
        Fit fit = fit_shape(record, form, start, iterations, stop);
        if (first || (fit.determined && (!best.determined || fit.sse < best.sse))) best = std::move(fit);
        first = false;
    }
    return best;
}

std::vector<Shape> most_promising(const CleanRecord& record, const ModelForm& form, const std::vector<Shape>& starts,
                                  std::stop_token stop) {
    const std::vector<double> sums = sums_of_squares(record, form, starts, stop);
    std::vector<int> order(starts.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return sums[a] < sums[b]; });
    std::vector<Shape> best;
    for (int i : order) {
        if (static_cast<int>(best.size()) < kStartsRefined) best.push_back(starts[i]);
    }
    return best;
}

Fit fit_form(const CleanRecord& record, const CleanRecord& thin, const ModelForm& form, const std::vector<Fit>& simpler,
             std::stop_token stop) {
    std::vector<Shape> starts = scan_shapes(thin, form, kStartsRefined, stop);
    std::vector<Shape> nested;
    for (const Fit& fit : simpler) {
        const std::vector<Shape> shapes = extend_shape(fit.shape, form.structure);
        if (!shapes.empty()) nested.push_back(shapes.front());
        starts.insert(starts.end(), shapes.begin(), shapes.end());
    }
    starts = most_promising(thin, form, starts, stop);
    Fit fit = best_from(thin, form, starts, kCoarseIterations, stop);
    fit = fit_shape(record, form, fit.shape, kFinalIterations, stop);
    const bool worse = std::any_of(simpler.begin(), simpler.end(), [&](const Fit& s) {
        return !extend_shape(s.shape, form.structure).empty() && fit.sse > s.sse;
    });
    if (worse && !nested.empty()) {
        Fit again = best_from(record, form, nested, kFinalIterations, stop);
        if (again.sse < fit.sse) fit = std::move(again);
    }
    return fit;
}

/// Differences of the criterion (Kass and Raftery 1995, section 3.2).
constexpr double kWorthAMention = 2, kStrong = 10;

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

/// Where the fit from rest leaves more than noise behind, and the user has not said where u was before: the starts that
/// could explain it. A single change at the first sample is the unseen step itself.
std::vector<Start> other_starts(const CleanRecord& r, const Fit& from_rest, double noise) {
    if (r.u0_given) return {};
    std::vector<Start> starts;
    if (is_integrating(from_rest.form.structure) && shows_rest(r)) starts.push_back(Start::steady_slope);
    const bool unexplained =
        from_rest.sse > 2 * r.samples() * noise * noise && correlation_time(from_rest.residual) > 3;
    if (unexplained && !(r.changes() == 1 && r.v_time[0] == 0)) starts.push_back(Start::other_level);
    return starts;
}

/// The residual variance below which fits count as equal, relative to y's range squared: rounding in the record's last
/// digits.
constexpr double kVarianceFloor = 1e-14;

}  // namespace

Fit fit_structure(const CleanRecord& record, const CleanRecord& thin, Structure structure,
                  const std::vector<Fit>& simpler, std::stop_token stop) {
    // A start that the simplest self-regulating structure needed, its extensions need too.
    const auto fopdt =
        std::find_if(simpler.begin(), simpler.end(), [](const Fit& f) { return f.form.structure == Structure::fopdt; });
    const bool known_start =
        fopdt != simpler.end() && fopdt->form.start == Start::other_level && !is_integrating(structure);
    if (known_start) {
        Fit fit = fit_form(record, thin, {structure, Start::other_level}, simpler, stop);
        if (fit.determined && plausible_rest(record, fit)) return fit;
    }
    Fit best = fit_form(record, thin, {structure, Start::at_rest}, simpler, stop);
    if (known_start) return best;
    const double noise = std::max(noise_std(record.y), quantisation_step(record.y) / std::sqrt(12.0));
    for (const Start start : other_starts(record, best, noise)) {
        Fit fit = fit_form(record, thin, {structure, start}, simpler, stop);
        if (!fit.determined || !plausible_rest(record, fit)) continue;
        if (start == Start::other_level && seen_at_rest(record, fit.shape.L(), noise)) continue;
        const double n = effective_samples(fit.residual);
        const bool better = information_criterion(record, fit, n) + kStrong < information_criterion(record, best, n);
        if (better) best = std::move(fit);
    }
    return best;
}

double level_of_rest(const Fit& fit) {
    return fit.form.start == Start::at_rest ? 0 : -fit.linear[fit.form.start_index()] / fit.linear[0];
}

double information_criterion(const CleanRecord& record, const Fit& fit, double independent_samples) {
    const double variance = fit.sse / record.samples() + kVarianceFloor;
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

Choice choose(const std::vector<Fit>& fits, const std::vector<double>& criteria, const std::vector<double>& percents,
              double independent_samples) {
    // A handicap makes "must win by" a comparison like any other.
    auto handicapped = [&](int i) {
        const bool unusual =
            fits[i].form.structure == Structure::sopdt_zero || fits[i].form.structure == Structure::unstable;
        return criteria[i] + (unusual ? kStrong - kWorthAMention : 0);
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
