// A PID whose proportional part is next to nothing where the loop works: the optimum of some resonances, and of plants
// that are nearly dead time alone, is integral action, or integral and derivative action. As a PID its gain and Ti are
// then next to 0 and their ratio is all that counts, so that a number typed for one of them means little by itself.
//
//   |Kp| < |Ki|/(1000 omega)  or  |Kp| < omega |Kd|/1000
//
// It is said of the ideal optimum, and of what is typed for a product or run sampled, whose own search may end there
// where the ideal one does not: a simplex over gain and times sees no end on the way to Ti = 0, only a cost that falls
// less and less.
#pragma once

#include <optional>

#include "engine/number_text.h"
#include "engine/warning.h"

namespace tunewright::robust {

/// Times 1/omega: beyond them a design is no ordinary PID.
inline constexpr double kShortTi = 1e-3, kLongTd = 1e3;

/// The warning "degenerate-design" of such times. `omega` (rad/time): where the loop works, such as that of Ms or the
/// reference frequency of a search.
inline std::optional<Warning> degenerate_design(double omega, double Ti, double Td) {
    if (Ti * omega >= kShortTi && Td * omega <= kLongTd) return std::nullopt;
    return Warning{"degenerate-design", "The optimum tends to pure integral and derivative action (Ti " + text(Ti) +
                                            "): a smaller Ms or a longer filter time gives an ordinary PID."};
}

}  // namespace tunewright::robust
