// Locates the operation of a plant's equations that leaves its domain.
#pragma once

#include <span>
#include <string>

#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// Which operation fails first when x goes on with the rates dx from time t (NonlinearSystem::domain_fault). u
/// absolute.
std::string fault_ahead(const NonlinearSystem& system, std::span<const double> x, std::span<const double> dx, double u,
                        double t);

}  // namespace tunewright
