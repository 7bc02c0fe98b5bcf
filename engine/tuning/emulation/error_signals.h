// What a PID makes of a sampled error: its integral and its filtered derivative, by cubic interpolation.
#pragma once

#include <vector>

namespace tunewright::emulation {

/// int from the first sample on; samples h apart, at least four.
std::vector<double> running_integral(const std::vector<double>& samples, double h);

/// (e - x)/Tf with Tf x' = e - x from x0: the derivative of e behind a first-order filter.
std::vector<double> filtered_derivative(const std::vector<double>& e, double h, double Tf, double x0);

}  // namespace tunewright::emulation
