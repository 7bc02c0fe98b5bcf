// Feedforward from a measured disturbance to a loop that has feedback.
//
//   y = P u + Pd d,   u = C (r - y) - F d,   F = Kf (Tz s + 1)/(Tp s + 1) e^(-Lf s)
//   y/d = (Pd - P F)/(1 + P C): the loop's peaks are those without feedforward
//
// a = L - Ld is the time by which the valve acts later than the disturbance. For a <= 0 the inverse is exact. For a > 0
// nothing can be seen before t = L: the error reaches at least its size without control at that time, for a first-order
// disturbance Kd (1 - exp(-a/Td)), whatever F. With integral action the integral of the error after a unit step is
// (K Kf - Kd) Ti/(K Kp), whatever the dynamics of F.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"
#include "engine/structure/step_figures.h"

namespace tunewright::structure {

struct Feedforward {
    double Kf = 0;          ///< u per d
    double Tz = 0, Tp = 0;  ///< time, >= 0; both 0: a gain alone
    double Lf = 0;          ///< time, >= 0

    /// The first move of u after a unit step, without a dead time.
    double jump() const { return Tp > 0 ? Kf * Tz / Tp : Kf; }
};

enum class FeedforwardKind {
    none,
    gain,     ///< static: Kd/K
    inverse,  ///< lead, lag and delay of the two plants, without the advance that cannot be built
    rule,     ///< Guzman and Hagglund 2011, Journal of Process Control 21, 92-102
    optimum,  ///< the least IAE with this feedback and a bounded first move
    given,    ///< the user's
};

/// "static" for gain, "guzman_hagglund" for rule.
const char* name_of(FeedforwardKind kind);

inline constexpr double kDefaultJump = 10, kDefaultWrong = 0.2;

struct FeedforwardProblem {
    LinearPlant plant, disturbance;
    IdealPid feedback;
    double jump = kDefaultJump;                         ///< largest |first move of u| after a unit step of d; > 0
    std::optional<Feedforward> given = {};              ///< judged, in place of the designs
    FeedforwardKind wanted = FeedforwardKind::optimum;  ///< of the designs: the one that conclusions are about
    double wrong = kDefaultWrong;                       ///< share by which gains and dead times are taken to be wrong
};

struct FeedforwardVariant {
    FeedforwardKind kind = FeedforwardKind::none;
    std::optional<Feedforward> compensator;  ///< empty: none, or it cannot be built
    std::string why_not;                     ///< one sentence, where it cannot
    StepFigures figures;                     ///< after a unit step of d
    double u_start = 0;                      ///< first move of u
    /// IAE if one of them is wrong: disturbance's gain low, high; plant's dead time short, long.
    std::vector<Figure> IAE_if_wrong;
};

/// The disturbance does not move y, to the accuracy of a simulation: figures with a compensator and without one.
bool is_exact(const StepFigures& with, const StepFigures& without);

struct FeedforwardResult {
    std::vector<FeedforwardVariant> variants;  ///< in the order of FeedforwardKind; with a given one that and none
    double late = 0;                           ///< a = L - Ld
    double peak_bound = 0;                     ///< |error| that no feedforward avoids
    bool partial = false;
};

/// The figures of one compensator; `exact` plants or wrong ones. Errors: those of add_pid().
Expected<FeedforwardVariant> judge_feedforward(const FeedforwardProblem& problem,
                                               const std::optional<Feedforward>& compensator);

/// Errors: invalid_argument ("feedback") if the loop without feedforward is not stable, ("disturbance") if the plant
/// has no finite gain against it.
Expected<FeedforwardResult> design_feedforward(const FeedforwardProblem& problem, const RunControl& control);

}  // namespace tunewright::structure
