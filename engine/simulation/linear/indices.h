// Performance indices from a response's nodes: integrals are exact for the cubics between nodes; the tail is known from
// the exact integral of the error.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// Integrals of the error e = target - y from 0 to the end of the nodes.
struct ErrorIntegrals {
    double IAE = 0, ISE = 0, ITAE = 0;
};

/// `error_integral_final` gives the tail of the IAE, in which e keeps its sign; if it is absent, the integrals end with
/// the nodes.
ErrorIntegrals error_integrals(const std::vector<ResponseNode>& nodes, double target,
                               std::optional<double> error_integral_final);

/// A change of the error's sign: in the step that ends with this node, after this fraction of the step, 0 to 1.
struct SignChange {
    std::size_t node;
    double part;
};
std::vector<SignChange> changes_of_sign(const std::vector<ResponseNode>& nodes, double target);

/// The error's integral from 0 to a fraction of the step from a to b.
double error_integral_at(const ResponseNode& a, const ResponseNode& b, double target, double part);

/// The fraction of a step after which the error changes its sign, if that of a similar response does so after `part`:
/// by one Newton step of at most a hundredth of the step.
double change_near(const ResponseNode& a, const ResponseNode& b, double target, double part);

/// The same IAE alone, because searches need it thousands of times.
double integral_of_absolute_error(const std::vector<ResponseNode>& nodes, double target,
                                  std::optional<double> error_integral_final);

/// Total variation of u from its value 0 before t = 0, jumps included.
double total_variation(const std::vector<ResponseNode>& nodes);

struct Extremes {
    double max = 0, t_max = 0, min = 0, t_min = 0;
};
Extremes extremes_of_y(const std::vector<ResponseNode>& nodes);

/// First time at which y reaches `level`, moving away from 0 (the sign of level decides); empty if never.
std::optional<double> first_reached(const std::vector<ResponseNode>& nodes, double level);

/// Last time at which |y - target| > band; 0 if it never leaves the band, empty if it is outside at the end.
std::optional<double> last_outside(const std::vector<ResponseNode>& nodes, double target, double band);

/// y and u at `points` equidistant times from 0 to `horizon` (after a jump at that time); held after the last node.
std::vector<std::pair<double, double>> sampled(const std::vector<ResponseNode>& nodes, double horizon, int points);

}  // namespace tunewright
