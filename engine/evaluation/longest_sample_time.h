// The longest sample time of a program for which the loop keeps the robustness of its design. A design assumes a
// controller that acts continuously. A program that acts once every sample time holds its output, which adds half a
// sample of dead time, and replaces integral and derivative by sums and differences.
//
//   const auto Ts = longest_sample_time(plant, gains, Ms, omega_Ms, kMsAsSampled);
#pragma once

#include <optional>
#include <stop_token>

#include "engine/controller/pid.h"
#include "engine/evaluation/evaluation.h"
#include "engine/figure.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// Largest ratio of Ms with sampling to Ms without: 5 % more.
constexpr double kMsAsSampled = 1.05;

/// The longest sample time at which a program with the backward rules keeps Ms within `factor` > 1 times `Ms`, the
/// continuous loop's, whose peak lies at `omega_Ms` (rad/time). Shorter sample times keep it too, as far as they were
/// tried: in steps of at most 4 % and of 0.15 rad of the fastest oscillation of the plant that can move Ms by 0.5 %,
/// and at those that divide the dead time into whole samples, where Ms has edges. Ms at the result equals the limit to
/// 1e-3. Empty if even a thousandth of 1/omega_Ms or a thirty-thousandth of the dead time exceeds the limit, or if a
/// thousand times 1/omega_Ms still keeps it. Needs a stable loop, `Ms` >= 1 and finite, `omega_Ms` > 0; all in the
/// plant's unit of time. Cost: usually two or more evaluations of the whole sampled loop; after 5,000 of them, or at a
/// request of `stop`, it is empty with that reason.
Figure longest_sample_time(const LinearPlant& plant, const ParallelPid& gains, double Ms, double omega_Ms,
                           double factor, const std::stop_token& stop = {});

/// The result for kMsAsSampled, for an evaluated controller. Empty if it is not defined: an unstable loop, a nonlinear
/// integral, a plant known by points alone.
std::optional<Figure> longest_sample_time_of(const AnalysedPlant& subject, const Evaluation& evaluation,
                                             const std::stop_token& stop = {});

}  // namespace tunewright
