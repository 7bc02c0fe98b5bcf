// How slowly a program may compute before the loop loses what its design promised. A design is made for a controller
// that acts all the time; one that acts once every sample time holds its output, which is half a sample of dead time
// more, and sums and differences stand for its integral and derivative.
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

/// What sampling may make of Ms: 5 % more.
constexpr double kMsAsSampled = 1.05;

/// The longest sample time that leaves Ms within `factor` > 1 times `Ms`, the continuous loop's, whose peak lies at
/// `omega_Ms` (rad/time): of the program with the backward rules. All shorter ones do so too, as far as they were
/// looked at: in steps of 4 % at most, of 0.15 rad of the fastest swing of the plant that can move Ms by 0.5 %, and at
/// those that go a whole number of times into the dead time, where Ms has edges. Ms there is that to 1e-3. Empty where
/// even a thousandth of 1/omega_Ms or a thirty-thousandth of the dead time does not, and where a thousand times
/// 1/omega_Ms still does. Needs a stable loop, `Ms` >= 1 and finite, `omega_Ms` > 0; all in the plant's unit of time.
/// Cost: mostly that of two or more looks at the whole sampled loop; after 5,000 of them, and where `stop` asks for it,
/// it is empty with that reason.
Figure longest_sample_time(const LinearPlant& plant, const ParallelPid& gains, double Ms, double omega_Ms,
                           double factor, const std::stop_token& stop = {});

/// The one for kMsAsSampled, of an evaluated controller. Empty where the question makes no sense: an
/// unstable loop, a nonlinear integral, a plant known by points alone.
std::optional<Figure> longest_sample_time_of(const AnalysedPlant& subject, const Evaluation& evaluation,
                                             const std::stop_token& stop = {});

}  // namespace tunewright
