#include "engine/identification/fit/uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "engine/identification/fit/load_doubt.h"
#include "engine/identification/fit/residual_noise.h"
#include "engine/identification/further_inputs/further_inputs.h"
#include "engine/identification/record/series.h"
#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/polynomial_roots.h"
#include "engine/plant/plant_family.h"

namespace tunewright {

namespace {

using Parameters = std::map<std::string, double>;

/// The plant's parameters by symbol, in the record's units. `lags`: the second order has the parameters T1, T2.
Parameters parameters_of(const RecordScale& s, const ModelForm& form, const ModelShape& shape,
                         std::span<const double> linear, bool lags) {
    const double K = linear[0] * s.y_scale / s.u_scale;
    Parameters p;
    p["L"] = shape.L() * s.t_scale;
    p["K"] = is_integrating(form.structure) ? K / s.t_scale : K;
    switch (form.structure) {
        case Structure::ipdt: break;
        case Structure::unstable: p["T"] = -shape.T() * s.t_scale; break;
        case Structure::fopdt:
        case Structure::ipdt_lag: p["T"] = shape.T() * s.t_scale; break;
        case Structure::sopdt:
            if (lags) {
                const double root = std::sqrt(std::max(0.0, 1 - 4 * std::exp(shape.p[2])));
                p["T1"] = 0.5 * shape.a1() * (1 + root) * s.t_scale;
                // The product of the lags keeps the accuracy of a small lag.
                p["T2"] = shape.a2() / (0.5 * shape.a1() * (1 + root)) * s.t_scale;
            } else {
                p["T"] = std::sqrt(shape.a2()) * s.t_scale;
                p["zeta"] = 0.5 * std::exp(-0.5 * shape.p[2]);
            }
            break;
        case Structure::sopdt_zero: p["b"] = linear[1] / linear[0] * s.t_scale; [[fallthrough]];
        case Structure::ipdt_second:
            p["a1"] = shape.a1() * s.t_scale;
            p["a2"] = shape.a2() * s.t_scale * s.t_scale;
            break;
        case Structure::third:
            p["a1"] = (shape.a1() + shape.T3()) * s.t_scale;
            p["a2"] = (shape.a2() + shape.a1() * shape.T3()) * s.t_scale * s.t_scale;
            p["a3"] = shape.a2() * shape.T3() * s.t_scale * s.t_scale * s.t_scale;
            break;
    }
    return p;
}

/// True if the quadratic factor has two real lags; lags that are equal within rounding count as two.
bool has_two_lags(const ModelShape& shape) {
    constexpr double kDampingRounding = 1e-9;
    return 4 * std::exp(shape.p[2]) <= 1 + kDampingRounding;
}

Plant plant_of(const ModelForm& form, const Parameters& p, bool lags) {
    auto at = [&](const char* name) { return p.at(name); };
    switch (form.structure) {
        case Structure::fopdt:
        case Structure::unstable: return Fopdt{at("K"), at("T"), at("L")};
        case Structure::sopdt:
            if (lags) return Sopdt{at("K"), at("T1"), at("T2"), at("L")};
            return OscillatorySopdt{at("K"), at("T"), at("zeta"), at("L")};
        case Structure::sopdt_zero:
            return TransferFunction{{at("K") * at("b"), at("K")}, {at("a2"), at("a1"), 1}, at("L")};
        case Structure::third: return TransferFunction{{at("K")}, {at("a3"), at("a2"), at("a1"), 1}, at("L")};
        case Structure::ipdt_second: return TransferFunction{{at("K")}, {at("a2"), at("a1"), 1, 0}, at("L")};
        case Structure::ipdt: return Ipdt{at("K"), at("L"), 0};
        case Structure::ipdt_lag: return Ipdt{at("K"), at("L"), at("T")};
    }
    return Fopdt{};
}

/// Intervals of samples that the model puts into the same step of y's grid: [first, last).
std::vector<std::pair<int, int>> plateaus(const Fit& fit, double grid) {
    constexpr int kMinRun = 8;
    std::vector<std::pair<int, int>> runs;
    const int n = static_cast<int>(fit.model.size());
    int first = 0;
    for (int i = 1; i <= n; ++i) {
        if (i < n && std::abs(fit.model[i] - fit.model[first]) < 0.5 * grid) continue;
        if (i - first >= kMinRun) runs.emplace_back(first, i);
        first = i;
    }
    return runs;
}

/// The error of rounding to a grid is the same over a whole plateau, unless noise dithers it: q/sqrt 12 without noise,
/// decreasing like the grid's first harmonic, e^(-2 pi^2 sigma^2/q^2), for noise sigma (Widrow and Kollar 2008, chapter
/// 19).
double common_rounding(double grid, double noise) {
    constexpr double kPi = std::numbers::pi;
    const double ratio = noise / grid;
    return grid / std::sqrt(12.0) * std::exp(-2 * kPi * kPi * ratio * ratio);
}

/// Changes of the parameters if drifts of the next two powers of time were fitted: small drifts hide in gain and time
/// constants without leaving a pattern. Each is shrunk by its expected size by chance (James and Stein 1961), so that
/// it counts only if the record supports it. `inverse` is that of J'J, `variance` the noise's over a long run.
std::vector<Eigen::VectorXd> drift_doubts(const Fit& fit, std::span<const double> t, const Eigen::MatrixXd& J,
                                          const Eigen::MatrixXd& inverse, double variance) {
    constexpr double kDependent = 1e-9;  // a power of time that the other columns explain up to this share is dependent
    if (is_integrating(fit.form.structure)) return {};
    const auto n = static_cast<Eigen::Index>(fit.residual.size());
    const Eigen::Map<const Eigen::VectorXd> residual(fit.residual.data(), n), time(t.data(), n);
    std::vector<Eigen::VectorXd> changes;
    Eigen::VectorXd before = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd q = fit.form.slope ? Eigen::VectorXd(time.array().square()) : Eigen::VectorXd(time);
    for (int column = 0; column < 2; ++column) {
        if (column > 0) q.array() *= time.array();
        const Eigen::VectorXd moved = inverse * transpose_times(J.topRows(n), q);
        Eigen::VectorXd alone = q - J.topRows(n) * moved;
        if (const double size = before.squaredNorm(); size > 0) alone -= before * (before.dot(alone) / size);
        const double size = alone.squaredNorm();
        if (!(size > kDependent * q.squaredNorm())) break;
        const double slope = alone.dot(residual) / size, z2 = slope * slope * size / variance;
        before = alone;
        // James and Stein's shrinkage of one normal value, positive part.
        constexpr double kChanceVariance = 2;
        if (z2 > kChanceVariance) changes.emplace_back(-slope * (1 - kChanceVariance / z2) * moved);
    }
    return changes;
}

/// Sums over `block` values, divided by the root of their number.
std::vector<double> block_sums(std::span<const double> values, std::size_t block) {
    std::vector<double> sums;
    sums.reserve(values.size() / block + 1);
    for (std::size_t i = 0; i < values.size(); i += block) {
        const auto part = values.subspan(i, std::min(block, values.size() - i));
        sums.push_back(std::reduce(part.begin(), part.end()) / std::sqrt(static_cast<double>(part.size())));
    }
    return sums;
}

/// The same for the first n entries; the others are not changed.
std::vector<double> block_sums(const std::vector<double>& values, std::size_t n, std::size_t block) {
    std::vector<double> sums = block_sums(std::span(values).first(n), block);
    sums.insert(sums.end(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
    return sums;
}

/// No gain is known better than this, relatively: actuator, plant and sensor together are not more linear, and a model
/// of a few lags is not more exact.
constexpr double kGainNonlinearity = 0.0005;

/// A long record's fit with a few thousand rows: means over a few rows, weighted by the root of their number, contain
/// nearly the same information on parameters and noise. `t` is condensed too.
Fit condensed(const Fit& fit, std::vector<double>& t) {
    constexpr std::size_t kMaxRows = 2000;
    const std::size_t n = fit.residual.size(), block = n / kMaxRows;
    if (block < 2) return fit;
    Fit less;
    less.form = fit.form;
    less.residual = block_sums(fit.residual, n, block);
    for (const std::vector<double>& column : fit.J) less.J.push_back(block_sums(column, n, block));
    t = block_sums(t, block);
    return less;
}

/// About a hundred rows are enough, because a load that matters changes slowly. J's columns are divided by `length`.
FittedRows few_rows(const Fit& fit, std::span<const double> times, const Eigen::VectorXd& length) {
    constexpr std::size_t kMinBlocks = 64, kBlocksPerColumn = 2;  // rows; and for each column that does not belong to a
                                                                  // parameter
    const std::size_t n = fit.residual.size(),
                      block = std::max<std::size_t>(1, n / (kMinBlocks + kBlocksPerColumn * fit.nuisance.size()));
    const auto rows = static_cast<Eigen::Index>((n + block - 1) / block);
    const auto sums = [&](std::span<const double> values) {
        const std::vector<double> blocks = block_sums(values.first(n), block);
        return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(blocks.data(), rows));
    };
    FittedRows few{sums(times),
                   Eigen::VectorXd::Constant(rows, std::sqrt(static_cast<double>(block))),
                   sums(fit.residual),
                   Eigen::MatrixXd(rows, length.size()),
                   Eigen::MatrixXd(rows, static_cast<Eigen::Index>(fit.nuisance.size())),
                   {},
                   {},
                   {}};
    const auto nuisances = static_cast<Eigen::Index>(fit.nuisance.size());
    for (Eigen::Index k = 0; k < nuisances; ++k) few.nuisance.col(k) = sums(fit.nuisance[static_cast<std::size_t>(k)]);
    few.known_weight = Eigen::Map<const Eigen::VectorXd>(fit.nuisance_weight.data(), nuisances);
    few.known_rest = Eigen::Map<const Eigen::VectorXd>(fit.nuisance_rest.data(), nuisances);
    few.known_J.resize(nuisances, length.size());
    few.weight[rows - 1] = std::sqrt(static_cast<double>(n - block * static_cast<std::size_t>(rows - 1)));
    few.time.array() /= few.weight.array();
    for (Eigen::Index k = 0; k < length.size(); ++k) {
        const std::vector<double>& column = fit.J[static_cast<std::size_t>(k)];
        few.J.col(k) = sums(column) / length[k];
        few.known_J.col(k) =
            Eigen::Map<const Eigen::VectorXd>(column.data() + column.size() - nuisances, nuisances) / length[k];
    }
    return few;
}

/// The least-squares problem at a fit, each column of J of length 1.
struct ScaledProblem {
    Eigen::MatrixXd J;        ///< samples, further rows, then one for each shape parameter
    Eigen::VectorXd length;   ///< lengths of the columns before scaling
    Eigen::MatrixXd inverse;  ///< of J'J
    Eigen::Index samples = 0;
    int shape = 0;  ///< number of parameters before the linear ones

    auto of_samples() const { return J.topRows(samples); }
    Eigen::MatrixXd below_samples() const { return J.bottomRows(J.rows() - samples); }
};

/// `variance`: long-run variance of the noise.
ScaledProblem scaled_problem(const Fit& fit, double variance) {
    constexpr double kNoLength = 1e-12;       // length of a column of zeros, as a divisor
    constexpr double kMinEigenvalue = 1e-13;  // eigenvalue of J'J (with diagonal 1) that counts as rounding
    const int m = fit.form.parameters(), data = static_cast<int>(fit.J[0].size());
    ScaledProblem p;
    p.shape = static_cast<int>(fit.form.searched().size());
    p.samples = static_cast<Eigen::Index>(fit.residual.size());
    p.J = Eigen::MatrixXd::Zero(data + p.shape, m);
    p.length.resize(m);
    for (int k = 0; k < m; ++k) {
        p.J.col(k).head(data) = Eigen::Map<const Eigen::VectorXd>(fit.J[k].data(), data);
        // Prior knowledge: a parameter that no sample shows is not longer than the record, and no lag is thousands of
        // times another.
        if (k < p.shape) p.J(data + k, k) = std::sqrt(variance) / (is_time(fit.form.searched()[k]) ? 1.0 : 4.0);
        p.length[k] = std::max(p.J.col(k).norm(), kNoLength);
        p.J.col(k) /= p.length[k];
    }
    const PrincipalAxes axes = principal_axes(gram(p.J, p.J));
    const Eigen::MatrixXd scaled =
        axes.vectors * axes.values.cwiseMax(kMinEigenvalue).cwiseSqrt().cwiseInverse().asDiagonal();
    p.inverse = scaled * scaled.transpose();
    return p;
}

/// The covariance of least squares under noise that is not white: (J'J)^-1 J'RJ (J'J)^-1 (Söderström and Stoica 1989,
/// section 4.2). The residual may come from slow noise or from a slowly varying load: with `load` the larger
/// uncertainty of the gain counts.
Eigen::MatrixXd open_covariance(const ScaledProblem& p, const ResidualNoise& left, const Fit& whole,
                                std::span<const double> times, bool load) {
    const Eigen::MatrixXd others = p.below_samples();
    const Eigen::MatrixXd prior = left.long_run_variance() * gram(others, others);
    Eigen::MatrixXd covariance = p.inverse * (left.weighed(p.of_samples()) + prior) * p.inverse;
    if (!load) return covariance;
    for (const Eigen::MatrixXd& spread : weighed_with_load(whole, few_rows(whole, times, p.length))) {
        const Eigen::MatrixXd with_load = p.inverse * (spread + prior) * p.inverse;
        if (with_load(p.shape, p.shape) > covariance(p.shape, p.shape)) covariance = with_load;
    }
    return covariance;
}

/// The rows are scaled deviations of (shape, linear), each one standard deviation long: one per principal axis of the
/// covariance, and one per plateau of a rounded y, or for drifts that are too small to be found.
Eigen::MatrixXd deviations_of(const Fit& whole, std::span<const double> times, double grid, double noise,
                              LoadDoubt load) {
    const double common = grid > 0 ? common_rounding(grid, noise) : 0;
    constexpr double kDithered = 0.02;  // of a step: with more noise, the rounding errors of successive samples are
                                        // independent
    const bool on_plateaus = common > kDithered * grid;
    std::vector<double> t(times.begin(), times.end());
    const Fit fit = on_plateaus ? whole : condensed(whole, t);
    const int m = fit.form.parameters();
    const int taken = m + static_cast<int>(std::lround(whole.nuisance_freedom));
    const ResidualNoise left(fit.residual, taken, grid * grid / 12);
    const ScaledProblem p = scaled_problem(fit, left.long_run_variance());
    const Eigen::MatrixXd covariance =
        open_covariance(p, left, whole, times, load == LoadDoubt::counted && !on_plateaus);
    const PrincipalAxes axes = principal_axes(0.5 * (covariance + covariance.transpose()));
    // Rounding that is the same over a plateau is not estimated from few samples, so it is not widened.
    const double widened = on_plateaus ? 1 : student_factor(left.freedom());
    std::vector<Eigen::VectorXd> all;
    all.reserve(static_cast<std::size_t>(m));
    for (int k = 0; k < m; ++k)
        all.emplace_back(widened * std::sqrt(std::max(axes.values[k], 0.0)) * axes.vectors.col(k));
    // Constraints of the model that are not samples add their own errors.
    for (std::size_t k = 0; k < whole.held_errors.size(); ++k)
        if (whole.held_errors[k] > 0)
            all.emplace_back(whole.held_errors[k] * p.inverse *
                             p.J.row(p.samples + static_cast<Eigen::Index>(k)).transpose());
    // Such rounding looks like a drift but is none.
    if (on_plateaus) {
        for (const auto& [first, last] : plateaus(fit, grid))
            all.emplace_back(common * (p.inverse * p.J.middleRows(first, last - first).colwise().sum().transpose()));
    } else {
        for (Eigen::VectorXd& change : drift_doubts(fit, t, p.J, p.inverse, left.long_run_variance()))
            all.push_back(std::move(change));
    }
    Eigen::MatrixXd deviations(static_cast<Eigen::Index>(all.size()), m);
    for (std::size_t k = 0; k < all.size(); ++k)
        deviations.row(static_cast<Eigen::Index>(k)) = (all[k].array() / p.length.array()).transpose();
    return deviations;
}

Eigen::MatrixXd given_deviations(const Fit& fit) {
    const int m = fit.form.parameters();
    Eigen::MatrixXd deviations(static_cast<Eigen::Index>(fit.deviations.size()), m);
    for (std::size_t k = 0; k < fit.deviations.size(); ++k)
        deviations.row(static_cast<Eigen::Index>(k)) =
            Eigen::Map<const Eigen::RowVectorXd>(fit.deviations[k].data(), m);
    return deviations;
}

}  // namespace

Plant plant_in_units(const RecordScale& scale, const Fit& fit) {
    const bool lags = has_two_lags(fit.shape);
    return plant_of(fit.form, parameters_of(scale, fit.form, fit.shape, fit.linear, lags), lags);
}

namespace {

/// Widens each parameter's error to at least that of `other`, without changing the correlations.
void widen_to(const FittedPlant& other, FittedPlant& plant) {
    const std::size_t size = plant.covariance.names.size();
    std::vector<double> factor(size, 1);
    for (std::size_t i = 0; i < size; ++i) {
        double& error = plant.standard_errors.at(plant.covariance.names[i]);
        const double min = other.standard_errors.at(plant.covariance.names[i]);
        if (!(min > error)) continue;
        if (error > 0) factor[i] = min / error;
        error = min;
    }
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) plant.covariance.matrix[i][j] *= factor[i] * factor[j];
        plant.covariance.matrix[i][i] = std::pow(plant.standard_errors.at(plant.covariance.names[i]), 2);
    }
}

}  // namespace

FittedPlant fitted_plant(const CleanRecord& record, const Fit& fit, double quantisation, double noise, LoadDoubt load) {
    constexpr double kMaxStandardError = 1e150;  // its square, the variance, is still finite
    const bool lags = has_two_lags(fit.shape);
    const Parameters best = parameters_of(record.scale, fit.form, fit.shape, fit.linear, lags);
    const std::vector<double> further = further_parameters(record, fit.form, fit.shape, fit.linear);
    std::vector<double> further_variances(further.size(), 0);
    FittedPlant result{plant_of(fit.form, best, lags), best, {}, {}, {}};
    ParameterCovariance& covariance = result.covariance;
    for (const auto& [name, value] : best) covariance.names.push_back(name);
    covariance.matrix.assign(best.size(), std::vector<double>(best.size(), 0));
    Eigen::MatrixXd deviations =
        fit.deviations.empty() ? deviations_of(fit, record.t, quantisation, noise, load) : given_deviations(fit);
    const std::vector<int> places = fit.form.searched();
    const double open = std::max(record.moves_unseen, record.moved_within);
    if (open > 0) {
        // u may have moved at any time in it, which is an error of the dead time.
        deviations.conservativeResize(deviations.rows() + 1, Eigen::NoChange);
        deviations.bottomRows(1).setZero();
        deviations(deviations.rows() - 1, 0) = open / std::sqrt(12.0);
    }
    const int size = static_cast<int>(places.size());
    for (int axis = 0; axis < deviations.rows(); ++axis) {
        // Differences along a long axis use a part of it and are scaled up, because the logarithms would overflow.
        const double reach = deviations.row(axis).head(size).cwiseAbs().maxCoeff();
        const double part = reach > 1 ? 1 / reach : 1;
        Parameters side[2];
        std::vector<double> further_side[2];
        for (int k = 0; k < 2; ++k) {
            const double sign = k == 0 ? part : -part;
            ModelShape shape = fit.shape;
            std::vector<double> linear = fit.linear;
            for (int i = 0; i < size; ++i) shape.p[places[i]] += sign * deviations(axis, i);
            for (std::size_t i = 0; i < linear.size(); ++i)
                linear[i] += sign * deviations(axis, size + static_cast<int>(i));
            if (linear[0] == 0) linear = fit.linear;
            side[k] = parameters_of(record.scale, fit.form, shape, linear, lags);
            further_side[k] = further_parameters(record, fit.form, shape, linear);
        }
        for (std::size_t i = 0; i < further.size(); ++i) {
            const double half = 0.5 * (further_side[0][i] - further_side[1][i]) / part;
            further_variances[i] += std::pow(std::clamp(half, -kMaxStandardError, kMaxStandardError), 2);
        }
        std::vector<double> half;
        for (const auto& [name, value] : side[0])
            half.push_back(std::clamp(0.5 * (value - side[1].at(name)) / part, -kMaxStandardError, kMaxStandardError));
        for (std::size_t i = 0; i < half.size(); ++i) {
            for (std::size_t j = 0; j < half.size(); ++j) covariance.matrix[i][j] += half[i] * half[j];
        }
    }
    const auto gain = static_cast<std::size_t>(std::ranges::find(covariance.names, "K") - covariance.names.begin());
    covariance.matrix[gain][gain] += std::pow(kGainNonlinearity * best.at("K"), 2);
    for (std::size_t i = 0; i < best.size(); ++i)
        result.standard_errors[covariance.names[i]] = std::sqrt(covariance.matrix[i][i]);
    result.disturbances = disturbances_of(record, fit, further, further_variances);
    if (!fit.deviations.empty() && fit.as_open_as_least_squares) {
        Fit by_least_squares = fit;
        by_least_squares.deviations.clear();
        widen_to(fitted_plant(record, by_least_squares, quantisation, noise, load), result);
    }
    return result;
}

namespace {

/// A plant in the dimensionless form of the fit.
struct PlantShape {
    ModelShape shape;
    double gain = 0, zero = 0;  ///< the linear coefficients of K and K b
};

/// Sets ln a1 and ln rho of a quadratic factor; false if it does not have positive coefficients.
bool set_quadratic(ModelShape& shape, double a1, double a2) {
    if (!(a1 > 0) || !(a2 > 0)) return false;
    shape.p[1] = std::log(a1);
    shape.p[2] = std::log(a2 / (a1 * a1));
    return true;
}

/// Factors three coefficients as (T3 s + 1)(q2 s^2 + q1 s + 1).
bool set_third(ModelShape& shape, double a1, double a2, double a3) {
    for (const std::complex<double> root : polynomial_roots(std::array{a3, a2, a1, 1.0})) {
        if (root.imag() != 0 || !(root.real() < 0)) continue;
        const double T3 = -1 / root.real();
        if (!set_quadratic(shape, a1 - T3, a3 / T3)) continue;
        shape.p[kThirdLag] = std::log(T3);
        return true;
    }
    return false;
}

std::optional<PlantShape> shape_of(const CleanRecord& r, const Fit& fit, const Plant& plant) {
    const auto at = [&](const char* name) { return parameter(plant, name); };
    const double t = r.scale.t_scale;
    const Structure structure = fit.form.structure;
    PlantShape found{fit.shape};
    found.shape.p[0] = at("L") / t;
    found.gain = at("K") * r.scale.u_scale / r.scale.y_scale * (is_integrating(structure) ? t : 1);
    bool whole = true;
    switch (structure) {
        case Structure::ipdt: break;
        case Structure::fopdt:
        case Structure::unstable:
        case Structure::ipdt_lag: {
            const double T = std::abs(at("T")) / t;
            whole = T > 0;
            found.shape.p[1] = std::log(T);
            break;
        }
        case Structure::sopdt:
            if (const double T1 = at("T1"); T1 > 0) {
                whole = set_quadratic(found.shape, (T1 + at("T2")) / t, T1 * at("T2") / (t * t));
            } else {
                const double T = at("T") / t;
                whole = set_quadratic(found.shape, 2 * at("zeta") * T, T * T);
            }
            break;
        case Structure::sopdt_zero: found.zero = found.gain * at("b") / t; [[fallthrough]];
        case Structure::ipdt_second: whole = set_quadratic(found.shape, at("a1") / t, at("a2") / (t * t)); break;
        case Structure::third:
            whole = set_third(found.shape, at("a1") / t, at("a2") / (t * t), at("a3") / (t * t * t));
            break;
    }
    return whole ? std::optional(found) : std::nullopt;
}

/// The residual sum of squares of a plant, with everything else that moved y fitted again.
class Misfit {
public:
    Misfit(const CleanRecord& record, const Fit& fit) : fit_(fit), stride_(std::max(1, record.samples() / kMaxRows)) {
        for (int i = 0; i < record.samples(); i += stride_) {
            t_.push_back(record.t[static_cast<std::size_t>(i)]);
            rest_.push_back(fit.residual[static_cast<std::size_t>(i)]);
        }
        input_ = {record.v_time, record.v_level};
        const auto rows = static_cast<Eigen::Index>(t_.size());
        // J's columns of parameters that are not the plant's, and of the times of moves.
        std::vector<const std::vector<double>*> columns;
        const int first = static_cast<int>(fit.form.searched().size()) + fit.form.gains();
        for (int k = first; k < fit.form.parameters(); ++k) columns.push_back(&fit.J[static_cast<std::size_t>(k)]);
        for (const auto& column : fit.nuisance) columns.push_back(&column);
        others_.resize(rows, static_cast<Eigen::Index>(columns.size()));
        for (Eigen::Index k = 0; k < others_.cols(); ++k)
            for (Eigen::Index i = 0; i < rows; ++i)
                others_(i, k) = (*columns[static_cast<std::size_t>(k)])[static_cast<std::size_t>(i * stride_)];
        constexpr double kRidge = 1e-9;  // of the longest column, because those of moves after the last row are 0
        Eigen::MatrixXd normal = gram(others_, others_);
        normal.diagonal().array() += kRidge * normal.diagonal().maxCoeff();
        inverse_ = inverse_of(normal);
        model_ = run({fit.shape, fit.linear[0], fit.form.gains() == 2 ? fit.linear[1] : 0});
        min_ = left(Eigen::VectorXd::Zero(rows));
    }

    /// The increase over the model's own sum, at least 0; infinite for a plant that the structure cannot represent.
    double growth(const std::optional<PlantShape>& plant) const {
        if (!plant) return INFINITY;
        return std::max(0.0, left(run(*plant) - model_) - min_);
    }

private:
    static constexpr int kMaxRows = 600;

    Eigen::VectorXd run(const PlantShape& plant) const {
        UnitResponse response;
        const bool zero = fit_.form.gains() == 2;
        unit_response(t_, input_, plant.shape, zero ? 1 : 0, response);
        const auto rows = static_cast<Eigen::Index>(t_.size());
        Eigen::VectorXd y = plant.gain * Eigen::Map<const Eigen::VectorXd>(response.x.data(), rows);
        if (zero) y += plant.zero * Eigen::Map<const Eigen::VectorXd>(response.x1.data(), rows);
        return y;
    }
    double left(const Eigen::VectorXd& moved) const {
        const Eigen::VectorXd e =
            Eigen::Map<const Eigen::VectorXd>(rest_.data(), static_cast<Eigen::Index>(rest_.size())) - moved;
        const Eigen::VectorXd pull = transpose_times(others_, e);
        return e.squaredNorm() - pull.dot(inverse_ * pull);
    }

    const Fit& fit_;
    int stride_;
    std::vector<double> t_, rest_;
    InputSteps input_;
    Eigen::MatrixXd others_, inverse_;
    Eigen::VectorXd model_;
    double min_ = 0;
};

/// True if the standard errors are so small that the sum of squares is quadratic over the whole region.
bool is_linear(const FittedPlant& plant) {
    constexpr double kMaxSmallError = 0.05;
    double lags = plant.values.at("L");
    for (const auto& [name, value] : plant.values)
        if (name == "T" || name == "T1" || name == "T2" || name == "a1") lags += std::abs(value);
    return std::ranges::all_of(plant.standard_errors, [&](const auto& error) {
        const auto& [name, size] = error;
        if (name == "K") return true;
        return size <= kMaxSmallError * (name == "L" ? lags : std::abs(plant.values.at(name)));
    });
}

}  // namespace

std::vector<double> region_reach(const CleanRecord& record, const Fit& fit, const FittedPlant& plant) {
    constexpr double kMinCurvatureGrowth = 1.5,
                     kCurvatureProbe = 0.02;  // multiple of the curvature's growth; share of the axis at which it is
                                              // measured
    constexpr int kHalvings = 7;
    if (is_linear(plant) || !fit.deviations.empty()) return {};
    const auto region = PlantRegion::of_covariance(plant.plant, plant.covariance.names, plant.covariance.matrix);
    if (!region) return {};
    const Misfit misfit(record, fit);
    const auto growth = [&](PlantRegion::Point z, double share) {
        for (double& x : z) x *= share;
        return misfit.growth(shape_of(record, fit, region->at(z)));
    };
    std::vector<double> reach;
    bool cut = false;
    for (const PlantRegion::Point& end : region->ends()) {
        const double curvature =
            0.5 * (growth(end, kCurvatureProbe) + growth(end, -kCurvatureProbe)) / (kCurvatureProbe * kCurvatureProbe);
        const auto linear = [&](double share) { return !(growth(end, share) > kMinCurvatureGrowth * curvature); };
        reach.push_back(linear(1) ? 1 : bisect({kCurvatureProbe, 1}, linear, kHalvings).inside);
        cut |= reach.back() < 1;
    }
    return cut ? reach : std::vector<double>{};
}

}  // namespace tunewright
