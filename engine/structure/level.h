// A PI controller of a level that smooths flows: the level uses the room it is given, so that the outflow moves as
// little as it can.
//
//   A dh/dt = q_in - q_out,   q_out = Kc (h + (1/Ti) int h dt),   w = sqrt(Kc/(A Ti)),   zeta = sqrt(Kc Ti/A)/2
//
// After a step D of the inflow the level rises to H = D E(zeta)/(A w), E = exp(-zeta acos(zeta)/sqrt(1 - zeta^2)), and
// the outflow overshoots by E^2. No controller that keeps the level within H moves the outflow at a lower rate than
// D^2/(2 A H) (McDonald, McAvoy and Tits 1986, AIChE Journal 32); with zeta = 0.4 a PI needs 4 % more.
#pragma once

#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/figure.h"

namespace tunewright::structure {

/// What the design aims at.
enum class LevelAim {
    rate,          ///< the lowest rate of the outflow: zeta = 0.4
    no_overshoot,  ///< an outflow that does not overshoot: proportional action alone, without return to the set point
    zeta,          ///< a given damping
};

/// The closed loop of the outflow, between the level controller's output and the flow.
struct FlowLoop {
    double T = 0, L = 0;  ///< lag and dead time, >= 0
};

struct LevelSettings {
    double Kc = 1;                  ///< flow per level, > 0
    std::optional<double> Ti = {};  ///< > 0; empty: proportional action alone
};

struct LevelProblem {
    double area = 1;     ///< volume per unit of level, > 0
    double step = 1;     ///< D, the largest step of the inflow, > 0
    double allowed = 1;  ///< H, the largest deviation of the level, > 0
    LevelAim aim = LevelAim::rate;
    double zeta = 0.4;  ///< for LevelAim::zeta, > 0
    double gap = 0;     ///< deviation within which a proportional controller rests, 0 <= gap < allowed
    std::optional<FlowLoop> flow = {};
    std::optional<LevelSettings> given = {};  ///< judged, in place of a design
};

struct LevelDesign {
    double Kc = 0;                            ///< flow per level
    double Ti = 0;                            ///< infinite: proportional action alone
    double zeta = 0, w = 0;                   ///< 0 without integral action
    double highest = 0, time_of_highest = 0;  ///< of the level; the time is infinite without integral action
    double largest_rate = 0;                  ///< of the outflow, flow per time
    double overshoot_percent = 0;             ///< of the outflow
    double rate_over_bound = 0;               ///< largest_rate over the bound for any controller
};

/// The figures of given settings; `Ti` infinite: proportional action alone.
LevelDesign judge_level(const LevelProblem& problem, double Kc, double Ti);

struct LevelResult {
    LevelDesign design;
    double bound = 0;                   ///< D^2/(2 A H)
    Figure Ms;                          ///< with the flow loop
    Figure highest, largest_rate;       ///< with the flow loop, from a simulation
    std::vector<LevelDesign> frontier;  ///< over zeta, then proportional action alone
};

/// Errors: invalid_argument for a number that is out of its range.
Expected<LevelResult> design_level(const LevelProblem& problem);

}  // namespace tunewright::structure
