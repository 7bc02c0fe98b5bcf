// A first-order model with dead time of a simulated step test: free of noise and offset, unlike a recorded one.
#pragma once

#include "engine/plant/plant.h"
#include "engine/simulation/experiment/nonlinear_experiments.h"

namespace tunewright::emulation {

/// The least sum of squared differences of the step responses over K, T > 0 and L >= 0; the test's last value counts
/// for as long again. Errors: unsupported for a test that has not settled.
Expected<Fopdt> first_order_model(const StepTest& test);

}  // namespace tunewright::emulation
