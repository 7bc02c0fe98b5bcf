// The start of a search whose optimum is known beforehand, nearly: that of a first-order plant with dead time.
#pragma once

#include <optional>

#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// ln of Kp, Ti and Td near the least load IAE under Ms = Mt = M, for one stable lag with dead time and L/T from
/// exp(-3) to exp(3): within 0.05 of each logarithm where M lies between 1.2 and 2 and the filter is a tenth of Td,
/// from a table of optima of the whole search over ln(L/T) and the limit. The optimum of such a plant depends on
/// nothing else, and a random search over these plants found no other local minimum. Empty: another plant, several
/// plants, another objective, a limit on |C S|, or outside the table.
std::optional<DesignPoint> known_start(const DesignProblem& problem);

}  // namespace tunewright::robust
