// Static measures of interaction: which input should control which output.
//
//   relative gains = K o (K^-1)^T (Bristol 1966),   Niederlinski index = det K/prod K_ii (Niederlinski 1971)
//
// Where a row integrates its slopes stand for the gains: neither measure depends on the units of rows and columns.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright::structure {

/// plants[i][j]: from u_j to y_i; empty: no path. As many columns as rows, two or three.
using PlantMatrix = std::vector<std::vector<std::optional<LinearPlant>>>;

/// Figures in rows.
using Table = std::vector<std::vector<double>>;

/// Column i is that of the input that controls output i.
inline PlantMatrix paired(const PlantMatrix& plants, const std::vector<int>& input_of) {
    PlantMatrix out(plants.size());
    for (std::size_t i = 0; i < plants.size(); ++i)
        for (const int input : input_of) out[i].push_back(plants[i][static_cast<std::size_t>(input)]);
    return out;
}

/// invalid_argument at "pairing" if a diagonal element is not there.
std::optional<Error> without_diagonal(const PlantMatrix& plants);

/// One way to pair outputs with inputs.
struct Pairing {
    std::vector<int> input_of;         ///< of each output
    Figure niederlinski;               ///< det K/prod K_ii of the paired gains
    std::vector<double> relative;      ///< the relative gain of each pair, at steady state
    std::vector<double> at_crossover;  ///< its magnitude near the crossovers
    bool possible = true;  ///< integral action in all loops, and in what is left when one is opened, can be stable
    double distance = 0;   ///< sum of |relative gain - 1| at both frequencies; smaller is better
};

struct GainAnalysis {
    Table gain;                     ///< at steady state; slopes where a row integrates
    Table relative;                 ///< relative gain array
    double condition = 0;           ///< largest over smallest singular value of `gain`
    std::vector<Pairing> pairings;  ///< the best first
};

/// Errors: invalid_argument for a matrix that is not square, not of two or three rows, or singular at steady state.
Expected<GainAnalysis> analyse_gains(const PlantMatrix& plants);

/// no_feasible_controller at "pairing" if the plants as they are paired have a negative index or relative gain, which
/// integral action does not stand (above), unless a plant is unstable. `gains`: of these plants.
std::optional<Error> impossible_pairing(const PlantMatrix& plants, const GainAnalysis& gains);

}  // namespace tunewright::structure
