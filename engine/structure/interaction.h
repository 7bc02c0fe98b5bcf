// Two or three loops whose outputs depend on each other's controllers.
//
//   y_i = sum_j P_ij (u_j + d_j),   u_i = C_i (r_i - y_i),   S = (I + P C)^-1
//
// With a decoupler (decoupling/decoupler.h) u = D C (r - y) and S = (I + P D C)^-1; the loads d enter behind it.
//
// S_ii = 1/(1 + L_i) exactly, L_i the loop i with all others closed. The limited peak is the structured singular value
// mu(S) for one complex gain in each output: max |S_ii| <= mu(S) <= largest singular value, and unlike the latter it
// does not depend on the units of the outputs. For two loops (Doyle 1982, the optimal scaling balances the
// off-diagonals)
//
//   f = |s11|^2 + |s22|^2 + 2 |s12 s21|,   mu^2 = (f + sqrt(f^2 - 4 |det S|^2))/2
//
// for three it is the least singular value over diagonal scalings (exact up to three blocks).
#pragma once

#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/progress.h"
#include "engine/structure/decoupling/decoupler.h"
#include "engine/structure/interaction_gains.h"

namespace tunewright::structure {

struct InteractionFigures {
    bool stable = false;
    std::vector<double> Ms_alone;          ///< loop i with the others in manual
    std::vector<double> Ms_others_closed;  ///< max |S_ii|
    double mu = 0, omega_mu = 0;
    double log_modulus = 0;        ///< dB: 20 log10 max |W/(1 + W)|, W = det(I + P C) - 1 (Luyben 1986)
    Table IAE_setpoint, IAE_load;  ///< [j][i]: of y_i after a unit step of set point or load j; or infinite
    std::vector<std::vector<int>> unstable_subsets;  ///< loops in automatic that are not stable together
    std::vector<bool> may_open;                      ///< loop i may be put in manual while the others stay in automatic
};

/// Controller i acts from y_i on u_i. Errors: those of add_pid(), at "controllers/i"; invalid_argument for a diagonal
/// with a path that is not there. A loop in manual takes its elements of the decoupler with it.
Expected<InteractionFigures> judge_interaction(const PlantMatrix& plants, const std::vector<IdealPid>& controllers,
                                               const Decoupling& decoupling = {});

/// The loops where the gain of any one path of the plant is wrong by the share `by`, up or down, and the decoupler is
/// what it was.
struct WrongGains {
    double by = 0.2;
    bool stable = false;
    Figure mu;  ///< the largest; empty where it is not stable
};
WrongGains with_wrong_gains(const PlantMatrix& plants, const std::vector<IdealPid>& controllers,
                            const Decoupling& decoupling, double by = 0.2);

inline constexpr double kDefaultMu = 1.8;

struct InteractionDesign {
    bool derivative = false;          ///< PID with Tf = Td/10 in place of PI
    double mu = kDefaultMu;           ///< limit, > 1
    std::vector<double> weight = {};  ///< of each output's IAE; empty: 1
    Decoupling decoupling = {};       ///< stays as it is
};

/// Biggest log modulus tuning: Kp = Ku/(2.2 F), Ti = Pu F/1.2, F so that the modulus is 2 n dB (Luyben 1986, Industrial
/// and Engineering Chemistry Process Design and Development 25, 654-660). Error: numerical_failure where no ultimate
/// gain exists.
struct BltSettings {
    std::vector<IdealPid> controllers;
    double F = 0;  ///< the detuning factor
};
Expected<BltSettings> blt(const PlantMatrix& plants);

struct InteractionResult {
    std::vector<IdealPid> controllers;
    std::vector<IdealPid> detuned;  ///< the loops' own settings, weakened until the limit holds; empty: never
    OrReason<BltSettings> blt;      ///< with the decoupler, if there is one
    InteractionFigures figures;
    bool partial = false;
};

/// The least weighted sum of the IAE of all outputs after unit loads at all inputs, within the limit on mu, with every
/// subset of the loops stable. Errors: those of judge_interaction(); no_feasible_controller, at "pairing" where no
/// controllers with integral action can be stable; those of the methods for the single loops.
Expected<InteractionResult> design_interaction(const PlantMatrix& plants, const InteractionDesign& design,
                                               const RunControl& control);

}  // namespace tunewright::structure
