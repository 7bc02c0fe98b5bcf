// The grammar of a plant that is typed as a formula of s. The reader takes words from a cursor; if the cursor has
// failed, the result is meaningless. `own_time`: seconds of the unit of the resulting times; 0: unknown, units are
// refused.
#pragma once

#include "engine/plant/typed/formula.h"
#include "engine/plant/typed/lists.h"
#include "engine/plant/typed/words.h"

namespace tunewright::typed {

/// A formula, up to the end of the text:
///
///   sum:      ["+" | "-"] product { ("+" | "-") product }
///   product:  signed { ("*" | "/") signed | factor }                  a factor without a sign between multiplies
///   signed:   ["+" | "-"] factor
///   factor:   primary [ "^" whole number ]
///   primary:  number [unit of time "s"] | "s" | e^... | exp( sum ) | call
///             | "(" sum ")" and { } [ ] | \frac{ sum }{ sum } | the name of a value
///
///   call:     of a function in plant_calls.h
///
/// e^-3s needs no brackets: its exponent extends to the next sign. After a division a factor without an operator is
/// refused, because some read 1/2s as 1/(2s) and others as s/2; a dead time is allowed.
Formula read_formula(Cursor& cursor, const Names& names, double own_time);

}  // namespace tunewright::typed
