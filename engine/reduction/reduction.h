// Reduces any linear plant to one of the few forms for which tuning rules are written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/plant.h"
#include "engine/warning.h"

namespace tunewright {

enum class ReductionMethod {
    automatic,       ///< the rule's preferred method, or the other one if it does not apply
    half_rule,       ///< Skogestad (2003): from poles and zeros
    tangent,         ///< from the exact step response: the tangent at its steepest point
    two_point_123c,  ///< Alfaro (2006): through 25 % and 75 % of the exact step response
    min_ise,
    min_iae,
    min_itae,  ///< least integrated difference of the step responses: min_error.h
};

/// Name of the method: "auto", "half_rule", "tangent", "123c", "min_ise", "min_iae", "min_itae".
const char* to_string(ReductionMethod method);

/// The method with this name; automatic for any other word.
ReductionMethod reduction_method(const std::string& word);

enum class ReducedOrder { first, second };

/// Definition of T in the tangent construction.
enum class TangentTime {
    at_63_percent,  ///< from the tangent's foot to the time at which 1 - 1/e of the change is reached
    by_slope,       ///< static gain over steepest slope: the length of the tangent
};

struct ReductionRequest {
    ReducedOrder order = ReducedOrder::first;
    ReductionMethod method = ReductionMethod::automatic;
    ReductionMethod preferred = ReductionMethod::half_rule;  ///< the method that `automatic` tries first
    TangentTime tangent_time = TangentTime::at_63_percent;
    std::optional<double> horizon = {};  ///< for min_*: the end of their integral; empty: until settled
};

/// K e^(-Ls) / (s^integrators (T1 s + 1)(T2 s + 1)) with T1 >= T2 >= 0, L >= 0; with an integrator T2 = 0, with two T1
/// = 0 as well.
struct ReducedModel {
    int integrators = 0;
    double K = 0;  ///< static gain, slope or acceleration per unit of u; any sign
    double T1 = 0;
    double T2 = 0;
    double L = 0;
    bool exact = false;  ///< the plant itself has this form: nothing was neglected
    std::vector<Warning> warnings = {};

    Plant plant() const;  ///< Fopdt, Sopdt, Ipdt, or a TransferFunction K/s^2
};

/// The plant in the requested order. One integrator is kept, and its lags become the model's dead time (the asymptote
/// of the ramp), except one lag with second order; two integrators are kept only with second order.
///
/// half_rule.h, step_reading.h and min_error.h state each construction. tangent, two_point_123c: K is the static gain;
/// stable plants are reduced to first order, whatever order is requested. They warn if the response is not essentially
/// monotone.
///
/// Errors: unsupported (`where` "plant" or "reduction/method") for right-half-plane poles, undamped modes, zeros at the
/// origin, too many integrators, and if the given method does not apply; the message names another. invalid_argument,
/// `where` "reduction/horizon", for a horizon with a method that has none, or one before the response moves. Sources:
/// Skogestad, J. Process Control 13 (2003), Eqs. 10-11 and Section 2.2; Hägglund & Åström, J. Process Control 14
/// (2004), Section 2; Alfaro, Ciencia y Tecnologia 24 (2006).
Expected<ReducedModel> reduce(const LinearPlant& plant, const ReductionRequest& request);

}  // namespace tunewright
