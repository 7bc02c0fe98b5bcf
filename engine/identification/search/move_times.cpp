#include "engine/identification/search/move_times.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

#include "engine/identification/fit/residual_noise.h"
#include "engine/identification/record/series.h"
#include "engine/identification/search/record_repair.h"
#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

/// A change of u whose time is unknown: its index in v_time, the time of the row before it and of the row that shows
/// it.
struct OpenMove {
    int place = 0;
    double low = 0, high = 0;

    double length() const { return high - low; }
    double middle() const { return 0.5 * (low + high); }
    double earliest() const { return low + 1e-3 * length(); }  ///< limits of the search: times are strictly ascending
    double deviation() const { return length() / std::sqrt(12.0); }
};

std::vector<OpenMove> open_moves(const CleanRecord& r) {
    constexpr double kMaxSpacings = 5.5;     // in usual spacings: with more missing rows there may be several minima
    constexpr double kTimeTolerance = 1e-9;  // of the record's length
    const double longest = kMaxSpacings * usual_spacing(r);
    std::vector<OpenMove> moves;
    for (int j = 0; j < r.changes(); ++j) {
        const auto row = std::ranges::lower_bound(r.t, r.v_time[j] - kTimeTolerance);
        if (row == r.t.begin() || row == r.t.end()) continue;
        const bool at_row = *row - r.v_time[j] < kTimeTolerance;
        if (!at_row && !r.moved_between_rows) continue;
        const double before = row_before(r, *row);
        if (before < *row && (*row - before <= longest || r.moved_between_rows)) moves.push_back({j, before, *row});
    }
    return moves;
}

/// d model/d time of the change at `place`, n rows.
Eigen::VectorXd slope_of_move(const CleanRecord& r, const Fit& fit, int place) {
    const double time = r.v_time[place];
    const double size[] = {r.v_level[place] - (place > 0 ? r.v_level[place - 1] : 0)}, at_once[] = {0};
    const auto first = std::ranges::lower_bound(r.t, time) - r.t.begin();
    std::vector<double> after;
    for (auto i = static_cast<std::size_t>(first); i < r.t.size(); ++i) after.push_back(r.t[i] - time);
    const bool zero = fit.form.gains() == 2;
    UnitResponse response;
    unit_response(after, {at_once, size}, fit.shape, zero ? 2 : 1, response);
    const auto rows = static_cast<Eigen::Index>(after.size());
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(r.samples());
    slope.tail(rows) = -fit.linear[0] * Eigen::Map<const Eigen::VectorXd>(response.x1.data(), rows);
    if (zero) slope.tail(rows) -= fit.linear[1] * Eigen::Map<const Eigen::VectorXd>(response.x2.data(), rows);
    return slope;
}

Eigen::MatrixXd slopes_of_moves(const CleanRecord& r, const Fit& fit, std::span<const OpenMove> moves) {
    Eigen::MatrixXd N(r.samples(), static_cast<Eigen::Index>(moves.size()));
    for (std::size_t k = 0; k < moves.size(); ++k)
        N.col(static_cast<Eigen::Index>(k)) = slope_of_move(r, fit, moves[k].place);
    return N;
}

/// Estimates shape, linear coefficients and times together.
class JointFit {
public:
    JointFit(const CleanRecord& record, std::vector<OpenMove> moves, const Fit& start, double noise,
             const std::stop_token& stop)
        : record_(record), moves_(std::move(moves)), noise_(noise), stop_(stop) {
        fit_ = fit_shape({&record_, {}}, start.form, start.shape, kRoughEffort, stop_);
        on_rows_ = innovation_variance(fit_.residual);
    }

    /// The evidence() of a model that is linear in the times, with white noise, at the recorded times: the residual
    /// there shows how much small shifts would explain.
    double linear_evidence() {
        variance_ = std::max(kVarianceFloor, residual_variance());
        jacobian({&record_, {}}, fit_);
        const Eigen::MatrixXd N = slopes_of_moves(record_, fit_, moves_);
        Eigen::VectorXd pull =
            transpose_times(N, Eigen::Map<const Eigen::VectorXd>(fit_.residual.data(), record_.samples()));
        double apart = 0;
        for (Eigen::Index k = 0; k < pull.size(); ++k) {
            const double to_middle = (at(k).middle() - at(k).high) / at(k).deviation();
            pull[k] = pull[k] * at(k).deviation() / variance_ + to_middle;
            apart += to_middle * to_middle;
        }
        Eigen::MatrixXd normal = seen_of(N);
        const double freedom = log_volume(normal);
        normal.diagonal().array() += 1;
        return 0.5 * pull.dot(solve_symmetric(normal, pull)) - 0.5 * apart - freedom;
    }

    /// Starts from the best of the recorded times, the middles of the rows and `times`, which belong to `shape`. Runs
    /// twice: with the noise of y from row to row, then with the residual of the fit.
    void run(const std::vector<double>& times, const ModelShape& shape) {
        std::vector<double> middles = record_.v_time;
        for (const OpenMove& move : moves_) middles[static_cast<std::size_t>(move.place)] = move.middle();
        take_if_better(middles, fit_.shape);
        take_if_better(times, shape);
        for (int round = 0; round < 2 && !stop_.stop_requested(); ++round) {
            variance_ = std::max(kVarianceFloor, residual_variance());
            if (round == 0) variance_ = std::min(variance_, std::max(kVarianceFloor, noise_ * noise_));
            descend();
        }
    }

    const CleanRecord& record() const { return record_; }
    const Fit& fit() const { return fit_; }

    /// The logarithm of the marginal likelihood relative to the recorded times, whose fit has the residual `on_rows_`.
    double evidence() const {
        const double n = record_.samples();
        const double left = innovation_variance(fit_.residual);
        return 0.5 * n * std::log(std::max(on_rows_, kVarianceFloor) / std::max(left, kVarianceFloor)) -
               log_volume(seen_of(slopes_of_moves(record_, fit_, moves_))) - 0.5 * surprise(record_);
    }

private:
    static constexpr Effort kRoughEffort{20, 1e-6};

    void take_if_better(const std::vector<double>& times, const ModelShape& shape) {
        CleanRecord record = record_;
        record.v_time = times;
        Fit there = fit_shape({&record, {}}, fit_.form, shape, kRoughEffort, stop_);
        if (there.determined && there.sse < fit_.sse) record_ = std::move(record), fit_ = std::move(there);
    }
    const OpenMove& at(Eigen::Index k) const { return moves_[static_cast<std::size_t>(k)]; }
    double residual_variance() const {
        const auto n = static_cast<double>(fit_.residual.size());
        const double taken = fit_.form.parameters() + 0.5 * static_cast<double>(moves_.size());
        return fit_.sse / std::max(0.2 * n, n - taken);
    }

    /// Information of the record about the times, given the model's parameters: their inverse covariance, each time in
    /// its own standard deviations.
    Eigen::MatrixXd seen_of(const Eigen::MatrixXd& N) const {
        const Eigen::MatrixXd J = sample_rows(fit_), of_both = gram(J, N);
        const Eigen::MatrixXd inverse = inverse_of(gram(J, J) + ridge(J));
        Eigen::MatrixXd seen = gram(N, N) - of_both.transpose() * inverse * of_both;
        for (Eigen::Index i = 0; i < seen.rows(); ++i)
            for (Eigen::Index k = 0; k < seen.cols(); ++k)
                seen(i, k) *= at(i).deviation() * at(k).deviation() / variance_;
        return seen;
    }
    /// Half the logarithm of the ratio of prior to posterior volume of the times.
    static double log_volume(const Eigen::MatrixXd& seen) {
        return 0.5 * (1 + principal_axes(seen).values.array().max(0)).log().sum();
    }

    /// Squared distances of the times from the middles of their rows, in standard deviations.
    double surprise(const CleanRecord& r) const {
        double sum = 0;
        for (const OpenMove& move : moves_)
            sum += std::pow((r.v_time[move.place] - move.middle()) / move.deviation(), 2);
        return sum;
    }
    double cost(const CleanRecord& r, const Fit& fit) const { return fit.sse + variance_ * surprise(r); }

    /// A share of its diagonal: fixes parameters without any effect.
    static Eigen::MatrixXd ridge(const Eigen::MatrixXd& J) {
        constexpr double kRidge = 1e-10;
        return (kRidge * J.colwise().squaredNorm().maxCoeff() * Eigen::VectorXd::Ones(J.cols())).asDiagonal();
    }

    void descend() {
        constexpr int kMaxIterations = 40, kMaxTries = 6;
        constexpr double kMinCostShare = 1e-6;  // of the cost
        double lambda = 1e-3;
        for (int i = 0; i < kMaxIterations && !stop_.stop_requested(); ++i) {
            jacobian({&record_, {}}, fit_);
            const Eigen::MatrixXd J = sample_rows(fit_), N = slopes_of_moves(record_, fit_, moves_);
            Eigen::MatrixXd both(J.rows(), J.cols() + N.cols());
            both << J, N;
            Eigen::MatrixXd normal = gram(both, both);
            Eigen::VectorXd pull =
                transpose_times(both, Eigen::Map<const Eigen::VectorXd>(fit_.residual.data(), record_.samples()));
            for (Eigen::Index k = 0; k < N.cols(); ++k) {
                const double weight = variance_ / std::pow(at(k).deviation(), 2);
                normal(J.cols() + k, J.cols() + k) += weight;
                pull[J.cols() + k] += weight * (at(k).middle() - record_.v_time[at(k).place]);
            }
            const double before = cost(record_, fit_);
            bool better = false;
            for (int k = 0; k < kMaxTries && !better; ++k) {
                better = step(normal, pull, lambda, before);
                lambda = better ? std::max(1e-9, lambda / 8) : lambda * 8;
            }
            if (!better || before - cost(record_, fit_) < kMinCostShare * before) break;
        }
        jacobian({&record_, {}}, fit_);
    }

    /// Fixes parameters at a bound that would be moved beyond it: a step that is cut there does not help.
    static void hold_at_bound(double value, double low, double high, Eigen::Index k, Eigen::MatrixXd& normal,
                              Eigen::VectorXd& pull) {
        if ((value > low || pull[k] > 0) && (value < high || pull[k] < 0)) return;
        normal.row(k).setZero();
        normal.col(k).setZero();
        normal(k, k) = 1;
        pull[k] = 0;
    }

    bool step(Eigen::MatrixXd normal, Eigen::VectorXd pull, double lambda, double before) {
        const std::vector<int> places = fit_.form.searched();
        const ShapeBounds bounds = shape_bounds(record_, fit_.form.structure);
        const Eigen::Index first = pull.size() - static_cast<Eigen::Index>(moves_.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto place = static_cast<std::size_t>(places[i]);
            hold_at_bound(fit_.shape.p[place], bounds.low[place], bounds.high[place], Eigen::Index(i), normal, pull);
        }
        for (Eigen::Index k = first; k < pull.size(); ++k)
            hold_at_bound(record_.v_time[at(k - first).place], at(k - first).earliest(), at(k - first).high, k, normal,
                          pull);
        normal.diagonal() *= 1 + lambda;
        const double min = 1e-12 * normal.diagonal().maxCoeff();
        normal.diagonal().array() += min;
        const Eigen::VectorXd moved = solve_symmetric(normal, pull);
        constexpr double kMaxLogStep = 1.5;  // of a logarithm: for larger steps the linearisation is meaningless
        double longest = 0;
        for (std::size_t i = 1; i < places.size(); ++i)
            longest = std::max(longest, std::abs(moved[static_cast<Eigen::Index>(i)]));
        const double share = longest > kMaxLogStep ? kMaxLogStep / longest : 1;
        ModelShape shape = fit_.shape;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto place = static_cast<std::size_t>(places[i]);
            shape.p[place] = std::clamp(shape.p[place] + share * moved[static_cast<Eigen::Index>(i)], bounds.low[place],
                                        bounds.high[place]);
        }
        CleanRecord next = record_;
        for (Eigen::Index k = first; k < pull.size(); ++k) {
            const OpenMove& move = at(k - first);
            double& time = next.v_time[move.place];
            time = std::clamp(time + share * moved[k], move.earliest(), move.high);
        }
        Fit fit = project({&next, {}}, fit_.form, shape);
        if (!fit.determined || !(cost(next, fit) < before)) return false;
        record_ = std::move(next);
        fit_ = std::move(fit);
        return true;
    }

    CleanRecord record_;
    std::vector<OpenMove> moves_;
    double noise_, variance_ = 0, on_rows_ = 0;
    const std::stop_token& stop_;
    Fit fit_;
};

/// Largest number of samples for which the sums over all pairs of columns are fast; 0: there are too many moves.
int affordable_samples(std::size_t moves) {
    constexpr double kMaxWork = 6e7;       // products: about some tenths of a second
    constexpr int kMinSamplesPerMove = 4;  // samples for each move
    const double columns = static_cast<double>(moves) + 8, max = kMaxWork / (columns * columns);
    return max < kMinSamplesPerMove * columns ? 0 : static_cast<int>(std::min(max, 1e6));
}

/// Effective dead time: with the lags of an integrator, else with half of all lags except the slowest (Skogestad 2003,
/// half rule).
double acting_dead_time(const ModelShape& shape) {
    const bool third = shape.structure == Structure::third;
    if (shape.structure == Structure::ipdt) return shape.L();
    const double lags = has_quadratic(shape.structure) ? shape.a1() + (third ? shape.T3() : 0) : shape.T();
    if (is_integrating(shape.structure)) return shape.L() + lags;
    if (shape.structure == Structure::unstable) return shape.L();
    return shape.L() + 0.5 * std::max(0.0, lags - shape.slowest_lag());
}

/// True if each move may lie anywhere between two rows.
bool seen_at_rows(const CleanRecord& r, double row) {
    constexpr int kMaxMoves = 5;                                  // moves: more come from a program
    constexpr double kMaxLateRows = 1.5, kMinRowsBetween = 2.99;  // rows
    if (r.row.empty() || r.changes() > kMaxMoves || r.moves_unseen > 0 || r.moves_placed > 0 || r.moved_between_rows ||
        !r.v_open.empty())
        return false;
    if (unevenly_spaced(r)) return false;
    for (int j = 0; j < r.changes(); ++j) {
        const double late = r.v_time[j] - row_before(r, r.v_time[j]);
        if (!(late > 0) || late > kMaxLateRows * row) return false;
        if (j > 0 && r.v_time[j] - r.v_time[j - 1] < kMinRowsBetween * row) return false;
    }
    return true;
}

/// True if y would show each single move that is half a row away from its row.
bool shown_on_rows(const CleanRecord& record, const Fit& fit, double row, const std::stop_token& stop) {
    constexpr double kMinLogLikelihoodGain = 4;  // two standard errors
    constexpr double kMinSse = 1e-14;            // of y's range squared: rounding
    constexpr Effort kRoughEffort{20, 1e-6};
    const double samples = effective_samples(fit.residual);
    const auto misfit = [&](const CleanRecord& moved) {
        return std::max(fit_shape({&moved, {}}, fit.form, fit.shape, kRoughEffort, stop).sse, kMinSse);
    };
    const double on_rows = misfit(record);
    for (std::size_t j = 0; j < record.v_time.size(); ++j) {
        CleanRecord moved = record;
        moved.v_time[j] -= 0.5 * row;
        if (samples * std::log(misfit(moved) / on_rows) < kMinLogLikelihoodGain) return false;
    }
    return true;
}

}  // namespace

std::optional<CleanRecord> with_move_times(const CleanRecord& record, const std::vector<double>& times,
                                           const Fit& start, double noise, bool pattern, const std::stop_token& stop) {
    constexpr double kMinEvidence = 5;  // logarithm of the ratio of likelihoods (Kass and Raftery 1995, section 3.2)
    constexpr std::size_t kMinMoves = 2;
    const std::vector<OpenMove> moves = open_moves(record);
    const int max = affordable_samples(moves.size());
    if (moves.size() < kMinMoves || max == 0) return std::nullopt;
    JointFit joint(every_few(record, max), moves, start, noise, stop);
    if (!(joint.linear_evidence() > 0) && !pattern) return std::nullopt;
    joint.run(times, start.shape);
    if (stop.stop_requested() || !(joint.evidence() > kMinEvidence)) return std::nullopt;
    CleanRecord placed = record;
    placed.v_time = joint.record().v_time;
    placed.v_open.assign(placed.v_time.size(), 0.0);
    double earliest = 1, latest = 0, row = 1;
    for (const OpenMove& move : moves) {
        placed.v_open[static_cast<std::size_t>(move.place)] = move.length();
        const double share = (placed.v_time[static_cast<std::size_t>(move.place)] - move.low) / move.length();
        earliest = std::min(earliest, share);
        latest = std::max(latest, share);
        row = std::min(row, move.length());
    }
    // Moves at the same phase of the logger's clock may lie together anywhere in a row. The uncertainty of the mean of
    // independent moves is already part of their own freedom.
    const double together = 1 - (latest - earliest), alone = 1 / static_cast<double>(moves.size());
    placed.moved_within = row * std::sqrt(std::max(0.0, together * together - alone));
    placed.moved_between_rows = false;
    return placed;
}

InputUnknowns time_unknowns(const CleanRecord& record, const Fit& fit) {
    std::vector<OpenMove> moves;
    for (std::size_t j = 0; j < record.v_open.size(); ++j)
        if (record.v_open[j] > 0) {
            const double seen = *std::ranges::lower_bound(record.t, record.v_time[j]);
            moves.push_back({static_cast<int>(j), seen - record.v_open[j], seen});
        }
    if (moves.empty()) return {};
    const auto count = static_cast<Eigen::Index>(moves.size());
    InputUnknowns unknowns{slopes_of_moves(record, fit, moves), Eigen::VectorXd(count), Eigen::VectorXd(count)};
    for (Eigen::Index k = 0; k < count; ++k) {
        const OpenMove& move = moves[static_cast<std::size_t>(k)];
        unknowns.deviation[k] = move.deviation();
        unknowns.rest[k] = move.middle() - record.v_time[static_cast<std::size_t>(move.place)];
    }
    return unknowns;
}

CleanRecord changed_between_rows(CleanRecord record) {
    for (double& time : record.v_time) {
        const auto row = std::lower_bound(record.t.begin(), record.t.end(), time);
        if (row != record.t.begin()) time = 0.5 * (time + *std::prev(row));
    }
    record.moved_between_rows = true;
    return record;
}

double shown_within(const CleanRecord& record, const Fit& fit, const std::stop_token& stop) {
    constexpr double kMaxSmallShare = 0.5;  // of the dead time in the record
    const double row = usual_spacing(record);
    if (!(row > kMaxSmallShare * acting_dead_time(fit.shape)) || !seen_at_rows(record, row)) return 0;
    if (record.changes() > 1 && shown_on_rows(record, fit, row, stop)) return 0;
    return 2 * row;  // at most one row before the recorded one
}

}  // namespace tunewright
