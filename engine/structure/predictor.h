// Dead-time compensation: a controller that acts on the prediction of a model, and a filter of the prediction's error.
//
//   u = C [ r - Gm u - F (y - Gm e^(-Lm s) u) ],   feedback controller C F/(1 + C Gm (1 - F e^(-Lm s)))
//
// F = 1: Smith (1957). With the exact model T = F T0 e^(-Ls), S = 1 - T, T0 = C Gm/(1 + C Gm). A PI that cancels the
// lag gives T0 = 1/(lambda s + 1): then Ms depends on lambda/L alone. The filtered predictor (Normey-Rico and Camacho
// 2007) has F T0 = (beta s + 1)/(Tf s + 1)^2 with beta = T (1 - (1 - Tf/T)^2 e^(-L/T)), 2 Tf + L for an integrator, so
// that the model's pole is no pole of y/d: Ms and y/d depend on Tf alone, y/r on T0. The predictive PI (Hagglund 1996)
// is the Smith PI with lambda = T.
//
// Ms does not see the danger: with |T0| <= 1 a Smith predictor has Ms < 2 however sharp it is, while the dead-time
// error that it tolerates falls to nothing. That window is a limit of its own.
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
#include "engine/tuning/limits.h"

namespace tunewright::structure {

enum class PredictorKind { smith, filtered_smith, predictive_pi };

/// K e^(-Ls)/(T s + 1), T < 0 unstable; or K e^(-Ls)/s.
struct PredictorModel {
    double K = 1, T = 1, L = 1;
    bool integrating = false;

    bool operator==(const PredictorModel&) const = default;
};

/// Coefficients in descending powers of s.
struct Rational {
    std::vector<double> num, den;
};

struct PredictorController {
    PredictorModel model;
    Rational C, F;                        ///< both proper, F(0) = 1
    double lambda = 0, Tf = 0, beta = 0;  ///< of the designs above; 0: not used
};

struct PredictorFigures {
    bool stable = false;
    int controller_unstable_poles = 0;  ///< of the controller by itself: it then must not run in manual
    double Ms = 0, Mt = 0;
    Figure dead_time_up, dead_time_down;   ///< of the plant's dead time: every smaller error is stable too
    OrReason<StepFigures> load, setpoint;  ///< unit steps; unknown on an unstable model, whose states run away
};

/// The controller on any plant, the model exact or not. Errors: those of the block diagram.
Expected<PredictorFigures> judge_predictor(const LinearPlant& plant, const PredictorController& controller);

/// The largest limit on Ms of a design: no Smith predictor has a peak of 2.
inline constexpr double kMaxPredictorMs = 1.99;

struct PredictorDesign {
    PredictorKind kind = PredictorKind::smith;
    double Ms = limits::kDefaultMs;              ///< limit, in (1, kMaxPredictorMs]
    std::optional<double> dead_time_error = {};  ///< share of L by which the dead time may be wrong either way
};

struct PredictorResult {
    PredictorController controller;
    PredictorFigures figures;
    std::optional<IdealPid> pid;        ///< the robust PID with the predictor's Ms as its limit
    Figure pid_IAE;                     ///< of a unit load
    bool limited_by_dead_time = false;  ///< the window, not Ms, bounds the design
};

/// The model of a plant of first order or of an integrator. Empty: the plant has another form.
std::optional<PredictorModel> model_of(const LinearPlant& plant);

/// Keeps the limits on the plant, which the model may describe roughly. Errors: no_feasible_controller if no setting
/// does; unsupported for an unstable or integrating model with a kind other than filtered_smith; invalid_argument for
/// numbers out of range.
Expected<PredictorResult> design_predictor(const PredictorModel& model, const LinearPlant& plant,
                                           const PredictorDesign& design, const RunControl& control);

}  // namespace tunewright::structure
