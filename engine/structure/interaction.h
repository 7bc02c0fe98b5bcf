// Two or three loops whose outputs depend on each other's controllers.
//
//   y_i = sum_j P_ij (u_j + d_j),   u_i = C_i (r_i - y_i),   S = (I + P C)^-1
//
// S_ii = 1/(1 + L_i) exactly, L_i the loop i with all others closed. The limited peak is the structured singular value
// mu(S) for one complex gain in each output: max |S_ii| <= mu(S) <= largest singular value, and unlike the latter it
// does not depend on the units of the outputs. For two loops (Doyle 1982, the optimal scaling balances the off-diagonals)
//
//   f = |s11|^2 + |s22|^2 + 2 |s12 s21|,   mu^2 = (f + sqrt(f^2 - 4 |det S|^2))/2
//
// for three it is the least singular value over diagonal scalings (exact up to three blocks).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "engine/blocks/block_diagram.h"
#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/progress.h"

namespace tunewright::structure {

/// plants[i][j]: from u_j to y_i; empty: no path. As many columns as rows, two or three; the diagonal must not be empty.
using PlantMatrix = std::vector<std::vector<std::optional<LinearPlant>>>;

/// One way to pair outputs with inputs.
struct Pairing {
    std::vector<int> input_of;      ///< of each output
    Figure niederlinski;            ///< det K/prod K_ii of the paired gains
    std::vector<double> relative;   ///< the relative gain of each pair, at steady state
    std::vector<double> at_crossover;  ///< its magnitude near the crossovers
    bool possible = true;           ///< integral action in all loops, and in what is left when one is opened, can be stable
    double distance = 0;            ///< of the relative gains from 1, both frequencies; smaller is better
};

struct GainAnalysis {
    Eigen::MatrixXd gain;      ///< at steady state; slopes where a row integrates
    Eigen::MatrixXd relative;  ///< relative gain array (Bristol 1966)
    double condition = 0;      ///< largest over smallest singular value of `gain`
    std::vector<Pairing> pairings;  ///< the best first
};

/// Errors: invalid_argument for a matrix that is not square, without a path on the diagonal, singular at steady state.
Expected<GainAnalysis> analyse_gains(const PlantMatrix& plants);

struct InteractionFigures {
    bool stable = false;
    std::vector<double> Ms_alone;          ///< loop i with the others in manual
    std::vector<double> Ms_others_closed;  ///< max |S_ii|
    double mu = 0, omega_mu = 0;
    double log_modulus = 0;                ///< dB: 20 log10 max |W/(1 + W)|, W = det(I + P C) - 1 (Luyben 1986)
    Eigen::MatrixXd IAE_setpoint, IAE_load;  ///< (j, i): of y_i after a unit step of set point or load j
    std::vector<std::vector<int>> unstable_subsets;  ///< loops in automatic that are not stable together
};

/// Controller i acts from y_i on u_i. Errors: those of add_pid().
Expected<InteractionFigures> judge_interaction(const PlantMatrix& plants, const std::vector<IdealPid>& controllers);

struct InteractionDesign {
    bool derivative = false;             ///< PID with Tf = Td/10 in place of PI
    double mu = 1.8;                     ///< limit, > 1
    std::vector<double> weight;          ///< of each output's IAE; empty: 1
};

struct InteractionResult {
    std::vector<IdealPid> controllers, blt, detuned;
    InteractionFigures figures;
    double F = 0;  ///< Luyben's detuning factor of `blt`
    bool partial = false;
};

/// Biggest log modulus tuning: Kp = Ku/(2.2 F), Ti = Pu F/1.2, F so that the modulus is 2 n dB (Luyben 1986, Industrial
/// and Engineering Chemistry Process Design and Development 25, 654-660). Error: numerical_failure where no ultimate
/// gain exists.
struct BltSettings {
    std::vector<IdealPid> controllers;
    double F = 0;
};
Expected<BltSettings> blt(const PlantMatrix& plants);

/// The least weighted sum of the IAE of all outputs after unit loads at all inputs, within the limit on mu, with every
/// subset of the loops stable. Errors: no_feasible_controller; those of the methods for the single loops.
Expected<InteractionResult> design_interaction(const PlantMatrix& plants, const InteractionDesign& design,
                                               const RunControl& control);

}  // namespace tunewright::structure
