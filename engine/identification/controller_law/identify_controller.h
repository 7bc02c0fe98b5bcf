// The settings of the controller that a record of its loop shows.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/controller/sampled/sampled_pid.h"
#include "engine/expected.h"
#include "engine/identification/record/record.h"
#include "engine/warning.h"

namespace tunewright {

struct ControllerRecordOptions {
    std::optional<double> sample_time = {};  ///< of the controller, record's unit, > 0; empty: found or unknown
    IntegralRule integral = IntegralRule::backward;
    std::optional<FilterType> filter = {};  ///< of the controller: taken among laws that are as good
};

/// The law u = Kp [(b r - y_f) + (1/Ti) int (r - y_f) dt + Td d/dt (c r - y_f)] that moved u, as a program computes it
/// with the integral's rule of the options (the trapezoidal rule has the Kp of the same Ki larger by Ki Ts/2 than the
/// backward rule). In the record's units. Terms that are 0 within two
/// standard deviations are left out, and weights that are 0 or 1 within them are so exactly.
struct IdentifiedController {
    IdealPid pid;
    /// One standard deviation of Kp, Ti, Td and Tf, of those that the law has, and of b if it is known. What rounding,
    /// the time between rows, other filters and other models of the errors may shift is included.
    std::map<std::string, double> standard_errors;
    /// Known well enough to be taken for today's settings without a question; else controller-uncertain warns.
    bool certain = false;
    std::optional<double> sample_time;  ///< given, or shown by a staircase of u or by rows that the law fits exactly
    double delay = 0;                   ///< time from a row's y to the row of the u that answers it
    bool b_known = false;               ///< the set point moves in automatic enough to tell b 0 from b 1; else b is 1
    double explained = 0;               ///< share of the moves of u, made white, that the law explains, 0 to 1
    int rows = 0;                       ///< used
    int manual_rows = 0, limited_rows = 0, odd_rows = 0;  ///< left out: manual, at ends of u, off the law
    std::vector<Warning> warnings;                        ///< controller-uncertain
};

/// 1. Samples: where u is a staircase over the rows, its steps; rows in manual (by the record's mode, else where u
/// stands still against the law) and at the ends of u are left out.
/// 2. For each delay (none, part of a row, one row, one sample), filter (none, of the derivative, of the measurement)
///    and error model (theta) the structures P, PI, PD and PID are fitted by generalised least squares
///    (law_regression.h); the least Bayesian information criterion decides. Tf is on a grid, then refined.
/// 3. Moves of u that are off the law by six deviations are left out, still stretches of u that the law explains by
///    rounding come in; step 2 again from what was found.
///    Where u lacks the noise of y and no law explains its moves, the controller reads y otherwise than the record
///    does: step 2 once more, without filters and with errors of u itself (law_search.h).
/// 4. Terms that are 0 within their errors are left out; the controller's own filter is preferred (law_terms.h).
/// 5. Rounding of y, where the residual has room for it, is taken out of the moments (law_uncertainty.h).
/// 6. Standard errors: of the residuals with their correlation; larger where rows do not show the time between samples,
///    and by what other laws nearly as good, other error models and errors of y make of Kp and Ti.
///
/// Of simulated loops on which no constant was chosen (tests/engine/identification/simulated_controller.h) nearly nine
/// in ten are answered and six are certain: Kp and Ti of 98 % of these are within 5 % and three standard errors. Of the
/// others, Kp and Ti of nine in ten are within three standard errors.
///
/// Errors: invalid_argument for columns of unequal length or a sample time that is not above 0; not_identifiable where
/// nothing moves, too few rows are in automatic, u does not follow the law, or Kp stays open.
Expected<IdentifiedController> identify_controller(const Record& record, const ControllerRecordOptions& options);

}  // namespace tunewright
