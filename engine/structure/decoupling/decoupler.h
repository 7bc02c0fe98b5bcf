// Decouplers of interacting loops: what the output of one controller adds to the others.
//
//   u_i = C_i (r_i - y_i) + sum_j E_ij u_j,   P D = P (I - E)^-1,   E_ii = 0
//
// Fed from what reaches the plant (inverted decoupling; Wade 1997, ISA Transactions 36, 3-10), so that it holds at
// limits and with loops in manual, and each loop alone has its own plant P_ii. Loads enter behind it: it does not see
// them.
//
//   static:      E_ij = -K_ij/K_ii, so that P(0) D = diag(K_ii)
//   simplified:  E_ij = -P_ij/P_ii, so that P D = diag(P_ii), as lead, lag and dead time
//
// The same D scaled to a diagonal of ones is K^-1 with its columns divided by their diagonal elements; the scale is a
// factor of the controllers' gains, the relative gain.
#pragma once

#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/structure/feedforward.h"
#include "engine/structure/interaction_gains.h"

namespace tunewright::structure {

/// elements[i][j]: from u_j to u_i, E_ij = Kf (Tz s + 1)/(Tp s + 1) e^(-Lf s); empty: none, as on the diagonal. Without
/// rows: no decoupling.
using Decoupling = std::vector<std::vector<std::optional<Feedforward>>>;

enum class DecouplerKind { none, static_gains, simplified };

/// "none", "static", "simplified".
const char* name_of(DecouplerKind kind);

struct Decoupler {
    DecouplerKind kind = DecouplerKind::none;
    Decoupling elements;
    /// [i][j]: time by which E_ij would have to act ahead of u_j, and does not; 0 of a static decoupler.
    Table unrealised;
};

/// The decoupler of paired plants. Errors at "decoupler", invalid_argument: an element that is not finite at steady
/// state or has no stable lead-lag; a decoupler that is not stable by itself. Those of analyse_gains().
Expected<Decoupler> design_decoupler(const PlantMatrix& plants, DecouplerKind kind);

}  // namespace tunewright::structure
