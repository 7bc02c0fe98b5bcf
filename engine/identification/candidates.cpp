#include "engine/identification/candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// The slope of an integrator at rest can be told from its response if the record shows y before u moves, or u moving
/// again.
bool shows_rest(const CleanRecord& r) {
    const auto before = std::count_if(r.t.begin(), r.t.end(), [&](double t) { return t <= r.v_time.front(); });
    return r.changes() > 1 || before >= 4;
}

/// A level of rest far from what u did is no level of rest: the structure is wrong, and the slope stands in for another
/// lag.
bool plausible_rest(const CleanRecord& r, const Fit& fit) {
    const double rest = -fit.linear[2] / fit.linear[0];
    if (r.changes() == 1) return std::abs(rest) <= 0.5;
    const auto [low, high] = std::minmax_element(r.v_level.begin(), r.v_level.end());
    return rest >= std::min(0.0, *low) && rest <= std::max(0.0, *high);
}

/// The residual variance below which fits count as equal, relative to y's range squared: rounding in the record's last
/// digits.
constexpr double kVarianceFloor = 1e-14;

}  // namespace

Fit fit_structure(const CleanRecord& record, const CleanRecord& thin, Structure structure,
                  const std::vector<Fit>& simpler, std::stop_token stop) {
    Fit fit = fit_form(record, thin, {structure, false}, simpler, stop);
    if (!is_integrating(structure) || record.u0_given || !shows_rest(record)) return fit;
    Fit free = fit_form(record, thin, {structure, true}, simpler, stop);
    if (!free.determined || !plausible_rest(record, free)) return fit;
    const double n = effective_samples(free.residual);
    return information_criterion(record, free, n) + 2 < information_criterion(record, fit, n) ? free : fit;
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
    constexpr double kWorthAMention = 2, kStrong = 10;
    // A handicap makes "must win by" a comparison like any other.
    auto handicapped = [&](int i) {
        return criteria[i] + (fits[i].form.structure == Structure::sopdt_zero ? kStrong - kWorthAMention : 0);
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
