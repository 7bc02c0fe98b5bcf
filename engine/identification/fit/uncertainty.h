// How sure the fitted parameters are.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/identification/fit/output_error.h"
#include "engine/identification/identify.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// The plant of a fit in the record's units, and the standard errors of its parameters.
struct FittedPlant {
    Plant plant;
    std::map<std::string, double> values;           ///< K, L and T, or T1, T2, or T, zeta, or a1, a2, b
    std::map<std::string, double> standard_errors;  ///< of the same; all finite and >= 0
    ParameterCovariance covariance;
    std::vector<DisturbanceModel> disturbances;
};

/// The plant alone.
Plant plant_in_units(const RecordScale& scale, const Fit& fit);

/// Whether the errors count a load that walks unseen (load_doubt.h): the work of a fit, for those that may be answered.
enum class LoadDoubt { counted, left_out };

/// Needs `fit.J`. The covariance counts what the residual says of its own noise (residual_noise.h), never less than the
/// variance of the rounding, quantisation^2/12, and is widened by Student's t so that 1.96 standard errors hold 95 %;
/// to it are added the errors that rounding makes in common over a plateau, and what drifts too small to be found would
/// change (`quantisation` and `noise`, y's standard deviation from sample to sample, dimensionless); carried to the
/// plant's parameters by differences along the principal axes of the covariance. Two lags give `Sopdt` (T1 >= T2), an
/// oscillation `OscillatorySopdt`; sopdt_zero a `TransferFunction` with num [K b, K], den [a2, a1, 1], third one with
/// num [K], den [a3, a2, a1, 1], ipdt_second one with num [K], den [a2, a1, 1, 0].
FittedPlant fitted_plant(const CleanRecord& record, const Fit& fit, double quantisation, double noise,
                         LoadDoubt load = LoadDoubt::counted);

/// A covariance is the region's shape near the model: lags and dead times enter y nonlinearly, and a long ellipsoid
/// holds plants that leave far more of y than any on the record's own contour (Bates and Watts 1988, chapter 6). The
/// shares, 0 to 1, of PlantRegion::ends() of the 95 % ellipsoid of `plant` at which the sum of squares has grown by
/// 1.5 times what its curvature at the model says of the whole axis; 1 where it never grows so far. Offset, start,
/// drift, load and times of moves are fitted to each plant anew.
///
/// Empty where nothing is cut, and where all standard errors are so small that the record is linear in the parameters.
/// `fit` has J's nuisance columns, of the samples of `record`. Cost: some hundred free runs over 600 samples at most.
std::vector<double> region_reach(const CleanRecord& record, const Fit& fit, const FittedPlant& plant);

}  // namespace tunewright
