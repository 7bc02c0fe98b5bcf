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
constexpr std::size_t kResponse = 400;  // rows of a load step's mark
constexpr double kLoadStep = 20;        // square of its size over its error
constexpr double kNegligible = 1e-3;    // of the mark's power
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

/// Through 1/(1 + c1 q + c2 q^2 + c3 q^3).
Series through(const std::array<double, 3>& c, const Series& x) {
    Series out(x.size());
    double y1 = 0, y2 = 0, y3 = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double y = x[i] - c[0] * y1 - c[1] * y2 - c[2] * y3;
        y3 = y2;
        y2 = y1;
        out[i] = y1 = y;
    }
    return out;
}

Series later(const Series& x, std::size_t rows) {
    Series out(x.size(), 0.0);
    if (rows < x.size()) std::copy(x.begin(), x.end() - std::ptrdiff_t(rows), out.begin() + std::ptrdiff_t(rows));
    return out;
}

/// x - p q x.
Series less(const Series& x, double p) {
    Series out(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = x[i] - (i > 0 ? p * x[i - 1] : 0);
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

/// The fit for one dead time.
class SpeedFit {
public:
    SpeedFit(const Series& dy, Series x) : dy_(dy), dy_before_(later(dy, 1)), x_(std::move(x)) {}

    Candidate from(Parameters start, std::vector<std::size_t> at) const {
        Candidate here;
        here.at = std::move(at);
        start.loads.assign(here.at.size(), 0.0);
        here.parameters = stable(std::move(start));
        here.residual = residual(here.parameters, here.at);
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
        for (std::size_t i = 0; i < w.size(); ++i) w[i] = dy_[i] - theta.a * dy_before_[i] - theta.b * x_[i];
        for (std::size_t k = 0; k < at.size(); ++k) w[at[k]] -= theta.loads[k];
        return w;
    }

    Series residual(const Parameters& theta, const std::vector<std::size_t>& at) const {
        return through(theta.c, less(parts(theta, at), theta.p));
    }

    std::vector<Series> slopes(const Candidate& here) const {
        const Parameters& theta = here.parameters;
        std::vector<Series> J;
        J.push_back(through(theta.c, less(dy_before_, theta.p)));
        J.push_back(through(theta.c, less(x_, theta.p)));
        J.push_back(through(theta.c, later(parts(theta, here.at), 1)));
        const Series filtered = through(theta.c, here.residual);
        for (std::size_t k = 1; k <= theta.c.size(); ++k) J.push_back(later(filtered, k));
        Series pulse(dy_.size(), 0.0);
        pulse[0] = 1;
        const Series mark = through(theta.c, less(pulse, theta.p));
        for (const std::size_t row : here.at) J.push_back(later(mark, row));
        return J;
    }

    /// One damped step; false: converged, or nothing is better.
    bool improve(Candidate& here, double& damping) const {
        const double scale = scale_of(here.residual), before = cost_of(here.residual, scale);
        const auto J = slopes(here);
        const auto n = Eigen::Index(J.size());
        Series weighted(dy_.size());
        Eigen::MatrixXd A(n, n);
        Eigen::VectorXd g(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const Series& column = J[std::size_t(i)];
            for (std::size_t row = 0; row < weighted.size(); ++row) {
                const double z = std::abs(here.residual[row]) / scale;
                weighted[row] = row < kSkipped ? 0 : column[row] * (z < kOutlier ? 1 : kOutlier / z);
            }
            g[i] = sum_of_products(weighted, here.residual);
            for (Eigen::Index k = 0; k <= i; ++k) A(i, k) = A(k, i) = sum_of_products(weighted, J[std::size_t(k)]);
        }
        for (int attempt = 0; attempt < kDampings; ++attempt, damping *= 10) {
            Eigen::MatrixXd damped = A;
            damped.diagonal() += damping * (A.diagonal().array() + 1e-12).matrix();
            const Eigen::VectorXd step = damped.ldlt().solve(g);
            if (!step.allFinite()) continue;
            Parameters next = here.parameters;
            next.a += step[0];
            next.b += step[1];
            next.p += step[2];
            for (std::size_t k = 0; k < 3; ++k) next.c[k] += step[Eigen::Index(3 + k)];
            for (std::size_t k = 0; k < next.loads.size(); ++k) next.loads[k] += step[Eigen::Index(6 + k)];
            next = stable(std::move(next));
            Series left = residual(next, here.at);
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
        Series e = residual(here.parameters, {});
        const double scale = scale_of(e);
        const std::size_t n = e.size(), length = std::min(kResponse, n);
        Series pulse(length, 0.0);
        pulse[0] = 1;
        Series mark = through(here.parameters.c, less(pulse, here.parameters.p));
        double square = sum_of_products(mark, mark), rest = 0;
        // The end of the mark that has hardly any of its power costs most of the time.
        while (mark.size() > 1 && rest + mark.back() * mark.back() < kNegligible * square) {
            rest += mark.back() * mark.back();
            mark.pop_back();
        }
        square -= rest;
        for (std::size_t i = 0; i < n; ++i) e[i] = i < kSkipped ? 0 : std::clamp(e[i], -30 * scale, 30 * scale);
        std::vector<std::size_t> found;
        for (int search = 0; search < kSearches; ++search) {
            double most = 0, size = 0;
            std::size_t best = 0;
            for (std::size_t row = kSkipped; row + 10 < n; ++row) {
                const std::size_t count = std::min(mark.size(), n - row);
                const double match =
                    sum_of_products(std::span(mark).first(count), std::span<const double>(e).subspan(row, count));
                if (const double score = match * match / square / (scale * scale); score > most) {
                    most = score;
                    best = row;
                    size = match / square;
                }
            }
            if (most < kLoadStep) break;
            found.push_back(best);
            for (std::size_t k = 0; k < std::min(mark.size(), n - best); ++k) e[best + k] -= size * mark[k];
        }
        std::ranges::sort(found);
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    const Series& dy_;
    Series dy_before_, x_;
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
    const Series first = later(du, std::size_t(whole) + 1), second = later(du, std::size_t(whole) + 2);
    Series out(du.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = (1 - part) * first[i] + part * second[i];
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
