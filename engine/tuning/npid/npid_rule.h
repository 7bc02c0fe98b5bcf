// Jin and Son's tuning rules for the nonlinear PID, and its optimum for a given plant.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct NpidOptions {
    bool optimise = false;  ///< search this plant's own optimum instead of using the rule's settings
    ReductionOptions reduction = {};
    FilterOptions filter{.Tf_over_Td = 0, .Tf = {}};  ///< of the derivative; none, as in the source
};

/// K Kp = a1 q^b1, Ti/T = a2 + b2 q, Td/T = a3 q^b3 with q = L/T: fits to optima of ISE, IAE, ITAE after a set-point
/// step on an FOPDT model, 0.01 <= q <= 3. The source's Table 2 holds up to q = 0.9, Table 3 from 1; in between, for
/// which the source has no table, Table 3 costs less. No filter, as in the source; the derivative does not act on the
/// set point. With "optimise": true the plant's own optimum (npid_optimum.h). The source's models are fitted by
/// min_iae, which is the default of `reduction` here.
///
/// Errors: those of rule_model(); unsupported for integrating plants, L = 0 and T = 0, unless `optimise` is true, which
/// needs no model; those of npid_optimum() with it. Warns `outside-validity` outside the range, and `rule-table` if
/// Table 3 is used.
///
/// Source: Jin & Son, Studies in Informatics and Control 28 (2019) 157-166, Tables 2 and 3.
TuningMethod npid_ise_method();
TuningMethod npid_iae_method();
TuningMethod npid_itae_method();

}  // namespace tunewright
