// The grammar of a plant that is typed as a formula of s. The reader takes words from a cursor; where the cursor has
// failed, what it answers means nothing. `own_time`: seconds of the unit that times are answered in; 0: not known,
// units are refused.
#pragma once

#include "engine/plant/typed/formula.h"
#include "engine/plant/typed/words.h"

namespace tunewright::typed {

/// A formula, up to the end of the text:
///
///   sum:      ["+" | "-"] product { ("+" | "-") product }
///   product:  signed { ("*" | "/") signed | factor }                  a factor without a sign between multiplies
///   signed:   ["+" | "-"] factor
///   factor:   primary [ "^" whole number ]
///   primary:  number [unit of time "s"] | "s" | e^... | exp( sum ) | call
///             | "(" sum ")" and { } [ ] | \frac{ sum }{ sum }
///
///   call:     tf(num, den [, 'InputDelay', L]) | zpk(zeros, poles, gain [, ...]) and their names in Python
///
/// e^-3s needs no brackets: its exponent goes on over what is written without a sign. After a division a factor without
/// a sign is refused (1/2s is 1/(2s) to some and s/2 to others), but for a dead time.
Formula read_formula(Cursor& cursor, double own_time);

}  // namespace tunewright::typed
