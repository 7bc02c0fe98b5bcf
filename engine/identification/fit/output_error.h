// Output-error least squares: the free run of a model against the measurement.
#pragma once

#include <complex>
#include <span>
#include <stop_token>
#include <vector>

#include "engine/identification/fit/response.h"

namespace tunewright {

/// The parts of a structure's model other than its shape. The linear coefficients are, in this order: the gain, gain
/// times b (sopdt_zero), the offset, and those of other causes of y, if they are fitted: the size of the unseen first
/// step (times the gain, and times gain b), the slope, the load (as the unseen step), and the gains of the further
/// inputs.
struct ModelForm {
    Structure structure = Structure::fopdt;
    bool other_level = false;  ///< at rest at an unknown level before the first sample, at which u took its first value
    bool slope = false;        ///< y drifts; for integrating structures: the level of rest is unknown
    bool load = false;  ///< a lasting step of unknown size is added to u from ModelShape::load_time on, without L
    int further = 0;    ///< further inputs: the first ones of CleanRecord::d, this number of them

    int gains() const { return structure == Structure::sopdt_zero ? 2 : 1; }
    int offset_index() const { return gains(); }
    int level_index() const { return gains() + 1; }
    int slope_index() const { return level_index() + (other_level ? gains() : 0); }
    int load_index() const { return slope_index() + (slope ? 1 : 0); }
    int further_index() const { return load_index() + (load ? gains() : 0); }
    int linear_size() const { return further_index() + further; }
    /// Indices in ModelShape::p of the searched parameters.
    std::vector<int> searched() const;
    int parameters() const { return shape_size(structure) + (load ? 1 : 0) + 2 * further + linear_size(); }
};

/// Bounds of the search, dimensionless, derived from the record's sampling and length.
struct ShapeBounds {
    std::array<double, 5 + 2 * kMaxFurtherInputs> low{}, high{};
};
/// ln of the least time constant of an unstable model: a free run over more than 20 of them is numerically meaningless.
inline constexpr double kMinUnstable = -2.995732273553991;
ShapeBounds shape_bounds(const CleanRecord& record, Structure structure);

/// The residual variance below which fits count as equal, relative to y's range squared: rounding in the record's last
/// digits.
inline constexpr double kVarianceFloor = 1e-14;

/// A measured value of the frequency response as a constraint: a row of the least-squares problem with this weight (the
/// inverse of its standard deviation relative to that of y's samples).
struct FrequencyConstraint {
    double omega = 0;  ///< dimensionless; 0: the static gain
    std::complex<double> value;
    double weight = 0;
    double std = 0;  ///< standard deviation of the value's parts, which may be larger than the weight implies
};

/// A model fitted to a clean record; dimensionless.
struct Fit {
    ModelForm form;
    ModelShape shape;
    std::vector<double> linear;    ///< linear_size() coefficients
    std::vector<double> model;     ///< n_samples: the free run
    std::vector<double> residual;  ///< n_samples: y - model
    double sse = 0;                ///< sum of squares, including those of y_rest's row and of the anchors
    /// Columns d model/d searched, then d model/d linear; rows as in the least-squares problem: n_samples, one for
    /// y_rest if there is one, then the anchors'. Empty until `jacobian`.
    std::vector<std::vector<double>> J;
    /// Standard deviation, in J's units, of the target of each row from n_samples on, if it differs from the row's own
    /// noise: 0 for y_rest's, then those of the anchors. As long as those rows; filled by `jacobian`.
    std::vector<double> held_errors;
    /// Columns of the additional parameters that were removed from J (nuisance.h), n_samples each.
    std::vector<std::vector<double>> nuisance;
    /// Prior knowledge of each of them, as one row of the least-squares problem: its weight, and its residual. J's last
    /// rows belong to these.
    std::vector<double> nuisance_weight, nuisance_rest;
    double nuisance_freedom = 0;  ///< degrees of freedom of the residual that they used
    bool determined = false;      ///< the gain's column is independent of the others
    int iterations = 0;
    /// Changes of (searched, linear), one standard deviation long each, that give the covariance if it comes from
    /// another estimator than least squares. Empty: J determines it.
    std::vector<std::vector<double>> deviations;
    /// For each parameter the larger of these errors and those of least squares counts.
    bool as_open_as_least_squares = false;
};

/// The data of a least-squares problem. The record and the anchors must outlive it.
struct FitData {
    const CleanRecord* record = nullptr;
    std::span<const FrequencyConstraint> anchors = {};
};

/// The linear coefficients for a fixed shape by orthogonal projection (variable projection: Golub and Pereyra 1973),
/// and the fit's residual.
Fit project(const FitData& data, const ModelForm& form, const ModelShape& shape);

/// Only the sums of squares, for many shapes, to about 1e-10 of y's own: for ranking starts. By normal equations.
std::vector<double> sums_of_squares(const FitData& data, const ModelForm& form, const std::vector<ModelShape>& shapes,
                                    const std::stop_token& stop);

/// Levenberg-Marquardt on the shape alone, the linear coefficients eliminated (Kaufman 1975's approximation of the
/// projected Jacobian), from `start`. Sensitivities to L and the load's time are exact, those to the logarithms are
/// central differences at fixed L, where the response is smooth. Stops when a step changes no shape parameter by more
/// than 1e-9 or lowers the sum of squares by less than `tolerance` of itself, after `max_iterations`, or after a stop
/// request.
struct Effort {
    int max_iterations = 60;
    double tolerance = 1e-11;
};
Fit fit_shape(const FitData& data, const ModelForm& form, const ModelShape& start, const Effort& effort,
              const std::stop_token& stop);

/// Fills `fit.J`.
void jacobian(const FitData& data, Fit& fit);

}  // namespace tunewright
