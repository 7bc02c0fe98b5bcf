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

/// The integrated autocorrelation time of a series, in samples, >= 1: 1 + 2 sum rho_k, the sum ended by Geyer's initial
/// positive sequence (Geyer 1992, section 3.3), of more than 3,000 samples by means of batches. White noise: 1. n
/// samples are worth n/(this) independent ones.
double correlation_time(std::span<const double> series);

/// Independent samples that a residual is worth, at least 4.
double effective_samples(std::span<const double> residual);

/// The plant of a fit in the record's units, and the standard errors of its parameters.
struct FittedPlant {
    Plant plant;
    std::map<std::string, double> values;           ///< K, L and T, or T1, T2, or T, zeta, or a1, a2, b
    std::map<std::string, double> standard_errors;  ///< of the same; all finite and >= 0
    ParameterCovariance covariance;
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

}  // namespace tunewright
