// The uncertainty of the fitted parameters.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/identification/fit/output_error.h"
#include "engine/identification/identify.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// The plant of a fit in the record's units, with the standard errors of its parameters.
struct FittedPlant {
    Plant plant;
    std::map<std::string, double> values;           ///< K, L and T, or T1, T2, or T, zeta, or a1, a2, b
    std::map<std::string, double> standard_errors;  ///< their standard errors; all finite and >= 0
    ParameterCovariance covariance;
    std::vector<DisturbanceModel> disturbances;
};

/// Only the plant.
Plant plant_in_units(const RecordScale& scale, const Fit& fit);

/// Treatment of a slowly varying load that was not noticed (load_doubt.h): to include it in the errors costs as much as
/// a fit, so this is only for models that may be the result.
enum class LoadDoubt { counted, left_out };

/// Needs `fit.J`. The covariance uses the noise model of the residual (residual_noise.h), with at least the variance of
/// the rounding, quantisation^2/12, and is widened by Student's t so that 1.96 standard errors contain 95 %. Added to
/// it are the errors of rounding that are common over a plateau, and the effect of drifts that are too small to be
/// found (`quantisation` and `noise`, y's standard deviation from sample to sample, dimensionless). It is converted to
/// the plant's parameters by differences along the principal axes. Two lags give `Sopdt` (T1 >= T2), an oscillation
/// `OscillatorySopdt`; sopdt_zero a `TransferFunction` with num [K b, K], den [a2, a1, 1], third one with num [K], den
/// [a3, a2, a1, 1], ipdt_second one with num [K], den [a2, a1, 1, 0].
FittedPlant fitted_plant(const CleanRecord& record, const Fit& fit, double quantisation, double noise,
                         LoadDoubt load = LoadDoubt::counted);

/// A covariance describes the region near the model: y depends nonlinearly on lags and dead times, and a long ellipsoid
/// contains plants with a much larger residual than any on the true contour (Bates and Watts 1988, chapter 6). The
/// shares, 0 to 1, of PlantRegion::ends() of the 95 % ellipsoid of `plant` at which the sum of squares has grown by 1.5
/// times the value that its curvature at the model gives for the whole axis; 1 if it never grows that much. Offset,
/// start, drift, load and times of moves are fitted again for each plant.
///
/// Empty if nothing is cut, or if all standard errors are so small that the response is linear in the parameters. `fit`
/// must have J's nuisance columns, for the samples of `record`. Cost: some hundred free runs over at most 600 samples.
std::vector<double> region_reach(const CleanRecord& record, const Fit& fit, const FittedPlant& plant);

}  // namespace tunewright
