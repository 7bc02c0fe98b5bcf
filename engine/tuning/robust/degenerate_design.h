// Detects a PID whose proportional part is negligible at the loop's frequencies. For some resonances, and for plants
// that are nearly pure dead time, the optimum is integral action, or integral and derivative action. As a PID it has a
// gain and a Ti near 0. Only their ratio matters, so neither number means much by itself.
//
//   |Kp| < |Ki|/(1000 omega)  or  |Kp| < omega |Kd|/1000
//
// The check applies to the ideal optimum, and to the settings of a product or of a sampled program. Their own search
// may end there even if the ideal one does not: a simplex over gain and times does not notice that Ti goes to 0,
// because the cost keeps falling, only more slowly.
#pragma once

#include <optional>

#include "engine/number_text.h"
#include "engine/warning.h"

namespace tunewright::robust {

/// Multiples of 1/omega: beyond them a design is not an ordinary PID.
inline constexpr double kShortTi = 1e-3, kLongTd = 1e3;

/// The warning "degenerate-design" for such times. `omega` (rad/time): a characteristic frequency of the loop, such as
/// that of Ms or the reference frequency of a search.
inline std::optional<Warning> degenerate_design(double omega, double Ti, double Td) {
    if (Ti * omega >= kShortTi && Td * omega <= kLongTd) return std::nullopt;
    return Warning{"degenerate-design", "The optimum tends to pure integral and derivative action (Ti " + text(Ti) +
                                            "): a smaller Ms or a longer filter time gives an ordinary PID."};
}

}  // namespace tunewright::robust
