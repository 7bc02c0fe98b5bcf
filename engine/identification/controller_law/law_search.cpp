#include "engine/identification/controller_law/law_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace tunewright {
namespace {

constexpr std::array kThetas = {0.0, 0.4, 0.7, 0.85, 0.94, 0.98, 1.0};
constexpr std::size_t kNearOne = 4;  // of kThetas
constexpr std::array kRatios = {0.06, 0.12, 0.25, 0.5, 0.8, 1.25, 2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 22.0, 32.0, 50.0};
// Additional penalty of the criterion on a derivative or a filter. Rounding and rows
// between samples make residuals that are not white, and each extra term explains a little of them.
constexpr double kExtraPenalty = 10;

/// Logarithm of the determinant that the free starts of the stretches leave.
double free_starts(const std::vector<char>& used, double theta) {
    double sum = 0;
    for (std::size_t j = 0; j < used.size();) {
        if (!used[j]) {
            ++j;
            continue;
        }
        double squares = 1, trace = 1;
        for (; j < used.size() && used[j]; ++j) trace *= theta, squares += trace * trace;
        sum += std::log(squares);
    }
    return sum;
}

class Search {
public:
    Search(const LawSamples& s, const std::vector<char>& used, double least_error, bool other_reading)
        : s_(s),
          used_(used),
          least_(least_error),
          first_theta_(other_reading ? kNearOne : 0),
          r_moves_(set_point_moves(s, used)) {
        for (std::size_t i = 0; i < kThetas.size(); ++i) starts_[i] = free_starts(used, kThetas[i]);
    }

    void try_shape(const LawShape& shape) {
        const LawColumns columns = law_columns(s_, shape);
        for (std::size_t i = first_theta_; i < kThetas.size(); ++i) {
            if (best_theta_ && (i + 1 < *best_theta_ || i > *best_theta_ + 1)) continue;
            const LawColumns white = whitened(columns, used_, kThetas[i], s_.r.empty());
            const LawMoments m = law_moments(white);
            for (const std::vector<int>& structure : structures(shape))
                keep(shape, structure, i, m, white[kLawTarget].size());
        }
        if (next_theta_) best_theta_ = next_theta_;
    }

    /// Of each kind, the best first.
    FoundLaws found() const {
        FoundLaws all;
        for (const auto& [kind, law] : best_) all.push_back(*law);
        std::ranges::sort(all, {}, &FoundLaw::criterion);
        return all;
    }

    /// The best of the kind of `law`, which was found.
    FoundLaw best_like(const FoundLaw& law) const {
        return *best_.at({law.shape.filter, law.has(kLawI), law.has(kLawD)});
    }

private:
    std::vector<std::vector<int>> structures(const LawShape& shape) const {
        std::vector<int> p = {kLawP}, i = {kLawI}, d = {kLawD};
        if (r_moves_) p.push_back(kLawSetPoint);
        const auto joined = [](std::vector<int> a, const std::vector<int>& b) {
            a.insert(a.end(), b.begin(), b.end());
            return a;
        };
        std::vector<std::vector<int>> all;
        if (shape.filter != LawFilter::derivative) all = {p, joined(p, i)};
        all.push_back(joined(p, d));
        all.push_back(joined(joined(p, i), d));
        if (r_moves_) all.push_back(joined(joined(joined(p, i), d), {kLawSetPointD}));
        return all;
    }

    void keep(const LawShape& shape, const std::vector<int>& structure, std::size_t theta, const LawMoments& m,
              std::size_t samples) {
        const LawFit f = fit_law(m, structure);
        if (!f.solved) return;
        const auto has = [&](int column) { return std::ranges::find(structure, column) != structure.end(); };
        const double P = f.value[kLawP];
        if (has(kLawI) && !(P * f.value[kLawI] > 0)) return;
        if (has(kLawD) && !(P * f.value[kLawD] > 0)) return;
        const auto n = static_cast<double>(samples);
        const double floor = least_ * least_ * 2 / (1 + kThetas[theta]);
        const int extra = (shape.filter != LawFilter::none) + has(kLawD) + has(kLawSetPointD);
        const double criterion = n * std::log(f.residual / n + floor) + starts_[theta] +
                                 (static_cast<double>(structure.size()) + extra) * std::log(n) + kExtraPenalty * extra +
                                 (shape.delay_rows > 0 || shape.delay_sample ? 2 : 0) +
                                 (shape.delay_rows != std::floor(shape.delay_rows) ? kExtraPenalty : 0);
        if (criterion < least_criterion_) least_criterion_ = criterion, next_theta_ = theta;
        std::optional<FoundLaw>& best = best_[{shape.filter, has(kLawI), has(kLawD)}];
        if (best && !(criterion < best->criterion)) return;
        best = FoundLaw{.shape = shape,
                        .columns = structure,
                        .theta = kThetas[theta],
                        .criterion = criterion,
                        .fit = f,
                        .samples = static_cast<int>(samples)};
    }

    const LawSamples& s_;
    const std::vector<char>& used_;
    double least_;
    std::size_t first_theta_;
    bool r_moves_;
    double least_criterion_ = 1e300;
    std::optional<std::size_t> best_theta_, next_theta_;  ///< the neighbours of the first are tried
    std::array<double, kThetas.size()> starts_ = {};
    std::map<std::tuple<LawFilter, bool, bool>, std::optional<FoundLaw>> best_;
};

}  // namespace

bool FoundLaw::has(LawColumn column) const { return std::ranges::find(columns, column) != columns.end(); }

namespace {

/// Narrows filter and delay of every law found so far that is at most `range` worse than the best.
void refine(Search& search, double range, double width, double last, bool own_steps, bool first) {
    FoundLaws now = search.found();
    if (now.empty()) return;
    const double limit = now.front().criterion + range;
    for (const FoundLaw& law : now) {
        if (law.criterion > limit) continue;
        LawShape centre = law.shape;
        const auto try_from_centre = [&](double ratio, double delay, bool between) {
            LawShape shape = centre;
            shape.ratio *= ratio;
            shape.delay_rows += delay;
            shape.between = between;
            search.try_shape(shape);
        };
        for (double w = width; w > last && centre.filter != LawFilter::none; w = std::sqrt(w)) {
            try_from_centre(1 / w, 0, centre.between);
            try_from_centre(w, 0, centre.between);
            centre = search.best_like(law).shape;
        }
        if (own_steps) continue;
        // Rows that are not the controller's own samples: its signals run on between them, its delay may end there.
        for (double step = 0.15; step > 0.03 && centre.delay_rows != std::floor(centre.delay_rows); step /= 2)
            for (const double by : {-step, step}) {
                try_from_centre(1, by, false);
                try_from_centre(1, by, true);
            }
        if (centre.filter == LawFilter::none || centre.between || !first) continue;
        for (const double factor : {0.7, 1.0}) try_from_centre(factor, 0, true);
    }
}

std::vector<LawShape> shapes_to_try(bool own_steps, bool with_filter) {
    std::vector<LawShape> delays = {{}, {.delay_rows = 1}}, shapes;
    if (own_steps) delays.push_back({.delay_sample = true});
    for (const double delay : {0.3, 0.6, 1.3, 1.6})
        if (!own_steps) delays.push_back({.delay_rows = delay});
    for (LawShape shape : delays) {
        shapes.push_back(shape);
        if (!with_filter || shape.delay_rows != std::floor(shape.delay_rows)) continue;
        for (const LawFilter filter : {LawFilter::derivative, LawFilter::measurement})
            for (const double ratio : kRatios) {
                shape.filter = filter;
                shape.ratio = ratio;
                shapes.push_back(shape);
            }
    }
    return shapes;
}

}  // namespace

FoundLaws search_law(const LawSamples& s, const std::vector<char>& used, double least_error, bool other_reading,
                     const FoundLaws& start) {
    Search search(s, used, least_error, other_reading);
    const bool own_steps = s.rows_per_sample > 1;
    for (const FoundLaw& law : start) search.try_shape(law.shape);
    if (start.empty()) {
        for (const LawShape& shape : shapes_to_try(own_steps, !other_reading)) search.try_shape(shape);
        refine(search, 60, 1.25, 1.05, own_steps, true);
    }
    refine(search, 15, 1.05, 1.0005, own_steps, start.empty());
    return search.found();
}

}  // namespace tunewright
