#include "engine/check/pace/loop_speed.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "engine/check/samples.h"
#include "engine/numerics/long_vectors.h"
#include "engine/numerics/polynomial_roots.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

using Series = std::vector<double>;

constexpr std::array<double, 16> kDeadTimes = {0.25, 0.5, 1, 1.5, 2, 3, 4, 5, 6, 8, 10, 13, 17, 22, 28, 36};  // rows
constexpr double kRowsPerTi = 80;
constexpr std::size_t kFewestRows = 400, kMostRows = 2500;
constexpr std::size_t kSkipped = 8;  // first rows, whose past is unknown
constexpr int kIterations = 12, kDampings = 8;
constexpr double kConverged = 0.01;              // of the robust cost
constexpr double kOutlier = 3, kFarOutlier = 8;  // standard deviations
constexpr double kLargestPole = 0.998;
constexpr double kLoadStep = 20;           // square of its size over its error
constexpr double kFarthest = 30;           // standard deviations of a residual in the search for steps
constexpr std::size_t kFewestBehind = 10;  // rows behind a step
constexpr double kCostOfStep = 5;
constexpr int kSearches = 3;
constexpr double kMad = 1.4826;  // standard deviation over the median magnitude, of a normal variable
// Crossover frequency times dead time: SIMC with tau_c = L gives 0.5, 2 L 0.33, 8 L 0.11.
constexpr double kLeastPace = 0.01, kSlowPace = 0.19, kMostPace = 2.5;
// A crossover far below 1/Ti: the loop is slower than the plant left alone.
constexpr double kUsualCrossoverTi = 0.75, kLeastOdds = 0.7, kMostOdds = 10;

struct Parameters {
    double a = 0, b = 0, p = 0;
    std::array<double, 3> c{};
    std::vector<double> loads = {};  ///< size of each step of the load, at `Candidate::at`
};

struct Candidate {
    Parameters parameters;
    Series residual;
    std::vector<std::size_t> at;  ///< rows of the steps of the load
    double cost = std::numeric_limits<double>::infinity();

    double penalised() const { return cost + kCostOfStep * double(at.size()); }
};

double robust(double z) {
    if (z < kOutlier) return 0.5 * z * z;
    return z < kFarOutlier ? kOutlier * z - 0.5 * kOutlier * kOutlier
                           : kOutlier * kFarOutlier - 0.5 * kOutlier * kOutlier;
}

double scale_of(const Series& residual) {
    Series sizes(residual.begin() + kSkipped, residual.end());
    for (double& value : sizes) value = std::abs(value);
    return kMad * median(std::move(sizes)) + 1e-300;
}

double cost_of(const Series& residual, double scale) {
    double sum = 0;
    for (std::size_t i = kSkipped; i < residual.size(); ++i) sum += robust(std::abs(residual[i]) / scale);
    return sum;
}

/// Through 1/(1 + c1 q + c2 q^2 + c3 q^3); `Value` is a number or some side by side, which take the time of one.
template <class Value>
std::vector<Value> through(const std::array<double, 3>& c, std::vector<Value> x) {
    Value y1 = Value(x[0] * 0), y2 = y1, y3 = y1;
    for (Value& value : x) {
        // The newest value comes last: everything else is computed while it is awaited.
        const Value y = (value - c[1] * y2 - c[2] * y3) - c[0] * y1;
        y3 = y2;
        y2 = y1;
        value = y1 = y;
    }
    return x;
}

/// Row i - rows; 0 before the first.
double at_row(const Series& x, std::size_t i, std::size_t rows) { return i >= rows ? x[i - rows] : 0; }

/// x - p q x.
Series less(const Series& x, double p) {
    Series out(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = x[i] - p * at_row(x, i, 1);
    return out;
}

/// Keeps the poles inside.
Parameters stable(Parameters theta) {
    const std::array<double, 4> polynomial = {1, theta.c[0], theta.c[1], theta.c[2]};
    auto roots = polynomial_roots(polynomial);
    bool moved = false;
    for (auto& root : roots)
        if (std::abs(root) > kLargestPole) {
            root *= kLargestPole / std::abs(root);
            moved = true;
        }
    if (moved && roots.size() == 3) {
        const std::complex<double> sum = roots[0] + roots[1] + roots[2],
                                   pairs = roots[0] * roots[1] + roots[0] * roots[2] + roots[1] * roots[2],
                                   product = roots[0] * roots[1] * roots[2];
        theta.c = {-sum.real(), pairs.real(), -product.real()};
    }
    theta.a = std::clamp(theta.a, 0.0, 1.0);
    theta.p = std::clamp(theta.p, 0.0, 0.9995);
    return theta;
}

/// A series with zeros before it, so that it can be read at any earlier row.
class Delayed {
public:
    Delayed(const Series& series, std::size_t most) : most_(most), padded_(most, 0.0) {
        padded_.insert(padded_.end(), series.begin(), series.end());
    }
    std::span<const double> by(std::size_t rows) const {
        return std::span(padded_).subspan(most_ - rows, padded_.size() - most_);
    }

private:
    std::size_t most_;
    Series padded_;
};

/// The fit for one dead time.
class SpeedFit {
public:
    SpeedFit(const Series& dy, Series x) : dy_(dy), x_(std::move(x)) {}

    Candidate from(Parameters start, std::vector<std::size_t> at) const {
        Candidate here;
        here.at = std::move(at);
        start.loads.assign(here.at.size(), 0.0);
        here.parameters = stable(std::move(start));
        here.residual = residual(parts(here.parameters, here.at), here.parameters);
        double damping = 1e-3;
        for (int i = 0; i < kIterations; ++i)
            if (!improve(here, damping)) break;
        const double scale = scale_of(here.residual);
        here.cost = cost_of(here.residual, scale) + double(here.residual.size() - kSkipped) * std::log(scale);
        return here;
    }

    /// The same, with the steps of the load that the residual shows.
    Candidate with_loads(Candidate best) const {
        for (int search = 0; search < kSearches; ++search) {
            auto at = loads_in(best);
            if (at == best.at) break;
            const std::size_t more = at.size();
            Candidate next = from(best.parameters, std::move(at));
            if (!(next.cost < best.cost - kCostOfStep * (double(more) - double(best.at.size())))) break;
            best = std::move(next);
        }
        return best;
    }

private:
    Series parts(const Parameters& theta, const std::vector<std::size_t>& at) const {
        Series w(dy_.size());
        for (std::size_t i = 0; i < w.size(); ++i) w[i] = dy_[i] - theta.a * at_row(dy_, i, 1) - theta.b * x_[i];
        for (std::size_t k = 0; k < at.size(); ++k) w[at[k]] -= theta.loads[k];
        return w;
    }

    static Series residual(const Series& parts, const Parameters& theta) {
        return through(theta.c, less(parts, theta.p));
    }

    /// The residual's derivative by each parameter, but for its sign: a, b and p, then c, then the loads.
    struct Slopes {
        std::array<Series, 3> by_abp;
        Delayed by_c, by_load;
    };

    Slopes slopes(const Candidate& here) const {
        const Parameters& theta = here.parameters;
        const std::size_t n = dy_.size();
        const Series w = parts(theta, here.at);
        std::vector<Eigen::Array4d> side_by_side(n);
        for (std::size_t i = 0; i < n; ++i)
            side_by_side[i] = {at_row(dy_, i, 1) - theta.p * at_row(dy_, i, 2), x_[i] - theta.p * at_row(x_, i, 1),
                               at_row(w, i, 1), here.residual[i]};
        side_by_side = through(theta.c, std::move(side_by_side));
        std::array<Series, 4> filtered;
        for (std::size_t k = 0; k < filtered.size(); ++k) {
            filtered[k].resize(n);
            for (std::size_t i = 0; i < n; ++i) filtered[k][i] = side_by_side[i][Eigen::Index(k)];
        }
        return {{std::move(filtered[0]), std::move(filtered[1]), std::move(filtered[2])},
                Delayed(filtered[3], theta.c.size()),
                here.at.empty() ? Delayed({}, 0) : Delayed(mark(theta), n)};
    }

    /// What a step of the load by 1 at row 0 leaves in the residual.
    Series mark(const Parameters& theta) const {
        Series pulse(dy_.size(), 0.0);
        pulse[0] = 1;
        return residual(pulse, theta);
    }

    /// Gauss and Newton's normal equations, with less weight on outliers.
    struct Equations {
        Eigen::MatrixXd A;
        Eigen::VectorXd b;
    };

    Equations equations(const Candidate& here, double scale) const {
        const Slopes found = slopes(here);
        std::vector<std::span<const double>> J(found.by_abp.begin(), found.by_abp.end());
        for (std::size_t k = 1; k <= here.parameters.c.size(); ++k) J.push_back(found.by_c.by(k));
        for (const std::size_t row : here.at) J.push_back(found.by_load.by(row));
        const std::size_t n = dy_.size();
        Series weight(n, 0.0), weighted(n);
        for (std::size_t i = kSkipped; i < n; ++i) {
            const double size = std::abs(here.residual[i]);
            weight[i] = size < kOutlier * scale ? 1 : kOutlier * scale / size;
        }
        const auto count = Eigen::Index(J.size());
        Equations out{Eigen::MatrixXd(count, count), Eigen::VectorXd(count)};
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto column = J[std::size_t(i)];
            for (std::size_t row = 0; row < n; ++row) weighted[row] = column[row] * weight[row];
            out.b[i] = sum_of_products(weighted, here.residual);
            for (Eigen::Index k = 0; k <= i; ++k)
                out.A(i, k) = out.A(k, i) = sum_of_products(weighted, J[std::size_t(k)]);
        }
        return out;
    }

    static Parameters moved(Parameters theta, const Eigen::VectorXd& step) {
        theta.a += step[0];
        theta.b += step[1];
        theta.p += step[2];
        for (std::size_t k = 0; k < 3; ++k) theta.c[k] += step[Eigen::Index(3 + k)];
        for (std::size_t k = 0; k < theta.loads.size(); ++k) theta.loads[k] += step[Eigen::Index(6 + k)];
        return stable(std::move(theta));
    }

    /// One damped step; false: converged, or nothing is better.
    bool improve(Candidate& here, double& damping) const {
        const double scale = scale_of(here.residual), before = cost_of(here.residual, scale);
        const Equations equal = equations(here, scale);
        for (int attempt = 0; attempt < kDampings; ++attempt, damping *= 10) {
            Eigen::MatrixXd damped = equal.A;
            damped.diagonal() += damping * (equal.A.diagonal().array() + 1e-12).matrix();
            const Eigen::VectorXd step = damped.ldlt().solve(equal.b);
            if (!step.allFinite()) continue;
            Parameters next = moved(here.parameters, step);
            Series left = residual(parts(next, here.at), next);
            const double after = cost_of(left, scale);
            if (!(after < before)) continue;
            here.parameters = std::move(next);
            here.residual = std::move(left);
            damping = std::max(damping / 10, 1e-6);
            return before - after >= kConverged;
        }
        return false;
    }

    /// Where the residual without known steps has the mark of one.
    std::vector<std::size_t> loads_in(const Candidate& here) const {
        const Parameters& theta = here.parameters;
        Series e = residual(parts(theta, {}), theta);
        const double scale = scale_of(e);
        const Series of_step = mark(theta);
        const double square = sum_of_products(of_step, of_step);
        const std::size_t n = e.size();
        for (std::size_t i = 0; i < n; ++i)
            e[i] = i < kSkipped ? 0 : std::clamp(e[i], -kFarthest * scale, kFarthest * scale);
        std::vector<std::size_t> found;
        for (int search = 0; search < kSearches; ++search) {
            // The products of the residual with the mark at each row are the residual, backwards, through its filter.
            const Series match = residual(Series(e.rbegin(), e.rend()), theta);
            std::size_t best = kSkipped;
            for (std::size_t row = kSkipped; row + kFewestBehind < n; ++row)
                if (std::abs(match[n - 1 - row]) > std::abs(match[n - 1 - best])) best = row;
            const double size = match[n - 1 - best] / square;
            if (size * size * square < kLoadStep * scale * scale) break;
            found.push_back(best);
            for (std::size_t row = best; row < n; ++row) e[row] -= size * of_step[row - best];
        }
        std::ranges::sort(found);
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    const Series& dy_;
    Series x_;
};

/// Differences in units of their own standard deviation, which is returned.
double scaled_differences(const Series& values, Series& out) {
    out.resize(values.size() - 1);
    for (std::size_t i = 0; i + 1 < values.size(); ++i) out[i] = values[i + 1] - values[i];
    const double spread = deviation(out) + 1e-300;
    for (double& value : out) value /= spread;
    return spread;
}

Series delayed(const Series& du, double dead_time) {
    const double whole = std::floor(dead_time), part = dead_time - whole;
    const auto rows = std::size_t(whole) + 1;
    Series out(du.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = (1 - part) * at_row(du, i, rows) + part * at_row(du, i, rows + 1);
    return out;
}

/// Each dead time from the starts, then from its neighbours, upwards and downwards.
std::vector<Candidate> candidates(const std::vector<SpeedFit>& fits, const std::stop_token& stop) {
    const Parameters starts[] = {{.a = 0.9, .b = 0.02, .p = 0.9, .c = {-1.9, 1.0, -0.1}},
                                 {.a = 0.95, .b = 0.02, .p = 0.95, .c = {-2.4, 1.9, -0.5}}};
    std::vector<Candidate> best(fits.size());
    const auto look = [&](std::size_t i, const Candidate* neighbour) {
        const auto consider = [&](Candidate&& found) {
            if (found.penalised() < best[i].penalised()) best[i] = std::move(found);
        };
        if (neighbour != nullptr)
            consider(fits[i].from(neighbour->parameters, neighbour->at));
        else
            for (const Parameters& start : starts) consider(fits[i].from(start, {}));
        if (std::isfinite(best[i].cost)) consider(fits[i].with_loads(best[i]));
    };
    for (std::size_t i = 0; i < fits.size() && !stop.stop_requested(); ++i) look(i, i > 0 ? &best[i - 1] : nullptr);
    for (std::size_t i = fits.size() - 1; i-- > 0 && !stop.stop_requested();) look(i, &best[i + 1]);
    return best;
}

/// The geometric mean of the values, weighted; 0 without weights.
double weighted_mean(const std::vector<double>& weights, const std::vector<double>& values) {
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i] * std::log(std::max(values[i], 1e-9));
        all += weights[i];
    }
    return all > 1e-12 ? std::exp(sum / all) : 0;
}

struct SpeedTerms {
    double gain, Ti, row, scale;  ///< scale: of y over u, of the differences
};

LoopSpeed judged(const std::vector<Candidate>& best, const std::vector<double>& dead_times, const SpeedTerms& terms) {
    const std::size_t count = best.size();
    double scale = std::numeric_limits<double>::infinity();
    for (const Candidate& one : best) scale = std::min(scale, scale_of(one.residual));
    std::vector<double> cost(count), pace(count), crossover(count), weight(count), dead(count);
    for (std::size_t i = 0; i < count; ++i) {
        cost[i] = cost_of(best[i].residual, scale) + 0.5 * kCostOfStep * double(best[i].at.size());
        const Parameters& theta = best[i].parameters;
        const double held = theta.a < 0.999 ? -std::log(std::max(theta.a, 1e-3)) / std::max(1 - theta.a, 1e-6) : 1;
        dead[i] = (dead_times[i] + 0.5) * terms.row;
        pace[i] = terms.gain * theta.b * terms.scale / terms.row * held * dead[i];
        crossover[i] = pace[i] / dead[i];
    }
    const double least = std::ranges::min(cost);
    double slow = 0, quick = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double above = std::log(dead_times[std::min(i + 1, count - 1)]),
                     below = std::log(dead_times[i > 0 ? i - 1 : 0]);
        const double width = (above - below) / (i > 0 && i + 1 < count ? 2 : 1);
        weight[i] = std::exp(-(cost[i] - least)) * width;
        if (pace[i] > kLeastPace && pace[i] < kSlowPace) slow += weight[i];
        if (pace[i] >= kSlowPace && pace[i] < kMostPace) quick += weight[i];
        if (!(pace[i] > 0.5 * kLeastPace && pace[i] < kMostPace)) weight[i] = 0;
    }
    LoopSpeed speed;
    speed.by_dead_time = slow + quick > 1e-9 ? slow / (slow + quick) : 0.5;
    speed.pace = weighted_mean(weight, pace);
    speed.dead_time = weighted_mean(weight, dead);
    speed.crossover_Ti = weighted_mean(weight, crossover) * terms.Ti;
    const double odds =
        std::clamp(std::pow(kUsualCrossoverTi / std::max(speed.crossover_Ti, 1e-9), 2), kLeastOdds, kMostOdds);
    const double likelihood = speed.by_dead_time;
    speed.slow = likelihood < 1 ? likelihood * odds / (likelihood * odds + 1 - likelihood) : 1;
    speed.information = std::ranges::max(cost) - least;
    speed.forward = double(std::ranges::count_if(pace, [](double value) { return value > 0; })) / double(count);
    speed.load_steps = int(std::ranges::min_element(best, {}, &Candidate::penalised)->at.size());
    speed.resolution = terms.row;
    return speed;
}

}  // namespace

std::optional<LoopSpeed> loop_speed(std::span<const double> measurement, std::span<const double> output, double gain,
                                    double Ti, double step, const std::stop_token& stop) {
    const std::size_t n = measurement.size();
    const double wanted = std::min(Ti / step / kRowsPerTi, double(n) / double(kFewestRows));
    const auto block =
        std::max({std::size_t{1}, static_cast<std::size_t>(std::max(1.0, wanted)), (n + kMostRows - 1) / kMostRows});
    const auto y = block_means(measurement, block), u = block_means(output, block);
    if (y.size() < kFewestRows / 4) return std::nullopt;
    Series dy, du;
    const double y_scale = scaled_differences(y, dy), u_scale = scaled_differences(u, du);
    std::vector<double> dead_times;
    std::vector<SpeedFit> fits;
    for (const double dead_time : kDeadTimes) {
        if (!(dead_time < double(y.size()) / 30)) break;
        dead_times.push_back(dead_time);
        fits.emplace_back(dy, delayed(du, dead_time));
    }
    if (fits.size() < 2) return std::nullopt;
    const auto best = candidates(fits, stop);
    if (stop.stop_requested()) return std::nullopt;
    return judged(best, dead_times, {gain, Ti, double(block) * step, y_scale / u_scale});
}

}  // namespace tunewright::check
