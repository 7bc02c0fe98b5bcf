// Output-error least squares: the free run of a model against the measurement.
#pragma once

#include <stop_token>
#include <vector>

#include "engine/identification/response.h"

namespace tunewright {

/// The state in which the record finds the plant.
enum class Start {
    at_rest,       ///< in equilibrium with u0, or with the first u
    steady_slope,  ///< integrating structures: moving steadily under the first u, the level of rest is unknown
    other_level,   ///< in equilibrium with an unknown level, which u left for its first value at the first sample
};

/// What the model of a structure is made of beside its shape. The linear coefficients are, in this order: the gain,
/// gain times b (sopdt_zero), the offset, and what `start` adds: a slope, or the size of the unseen first step (times
/// the gain, and times gain b).
struct ModelForm {
    Structure structure = Structure::fopdt;
    Start start = Start::at_rest;

    int gains() const { return structure == Structure::sopdt_zero ? 2 : 1; }
    int offset_index() const { return gains(); }
    int start_index() const { return gains() + 1; }
    int start_size() const { return start == Start::at_rest ? 0 : start == Start::steady_slope ? 1 : gains(); }
    int linear_size() const { return gains() + 1 + start_size(); }
    int parameters() const { return shape_size(structure) + linear_size(); }
};

/// Bounds of the search, dimensionless, from the record's sampling and length.
struct ShapeBounds {
    std::array<double, 3> low{}, high{};
};
ShapeBounds shape_bounds(const CleanRecord& record, Structure structure);

/// A model fitted to a clean record; dimensionless.
struct Fit {
    ModelForm form;
    Shape shape;
    std::vector<double> linear;    ///< linear_size() coefficients
    std::vector<double> model;     ///< n_samples: the free run
    std::vector<double> residual;  ///< n_samples: y - model
    double sse = 0;                ///< sum of squares, that of y_rest's row included
    /// Columns d model/d shape, then d model/d linear; n_samples rows and one more for y_rest if there is one. Empty
    /// until `jacobian`.
    std::vector<std::vector<double>> J;
    bool determined = false;  ///< the gain's column is independent of the others
    int iterations = 0;
};

/// The linear coefficients for a fixed shape by orthogonal projection (variable projection: Golub and Pereyra 1973),
/// and the fit's residual.
Fit project(const CleanRecord& record, const ModelForm& form, const Shape& shape);

/// The sum of squares alone, of many shapes.
std::vector<double> sums_of_squares(const CleanRecord& record, const ModelForm& form, const std::vector<Shape>& shapes,
                                    std::stop_token stop);

/// Levenberg-Marquardt on the shape alone, the linear coefficients eliminated (Kaufman 1975's approximation of the
/// projected Jacobian), from `start`. Sensitivity to L is exact (-dx/dt), those to the logarithms are central
/// differences at fixed L, where the response is smooth. Stops when a step changes no shape parameter by more than
/// 1e-9 or lowers the sum of squares by less than 1e-11 of itself, after `most_iterations`, or when asked to.
Fit fit_shape(const CleanRecord& record, const ModelForm& form, const Shape& start, int most_iterations,
              std::stop_token stop);

/// Fills `fit.J`.
void jacobian(const CleanRecord& record, Fit& fit);

}  // namespace tunewright
