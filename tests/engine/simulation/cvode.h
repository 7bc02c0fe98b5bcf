// SUNDIALS' CVODE (backward differentiation formulas, Hindmarsh et al. 2005) as an integrator that owes ours nothing.
#pragma once

#include <functional>
#include <vector>

namespace tunewright {

using CvodeRates = std::function<void(double t, const double* x, double* dx)>;

/// x at `samples` even times from 0 to t_end, both included. Absolute tolerances are relative to `sizes`.
std::vector<std::vector<double>> cvode_states(const CvodeRates& rates, std::vector<double> x, double t_end, int samples,
                                              double relative_tolerance, const std::vector<double>& sizes);

}  // namespace tunewright
