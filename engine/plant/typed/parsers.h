// The two grammars of a typed plant. Every reader takes words from a cursor; where the cursor has failed, what it
// answers means nothing. `own_time`: seconds of the unit that times are answered in; 0: not known, units are refused.
#pragma once

#include <string>

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

/// Whether a name in lower case is one of the calls, tf or zpk or another name of them.
bool is_matrix_call(const std::string& name);

/// The call whose name is at the cursor, a bracket behind it. Lists are written [1 2], [1, 2] or [1; 2]; the delay may
/// be written InputDelay=L too.
Formula read_matrix_call(Cursor& cursor);

/// Whether a text is one of parameters: it begins with one of their words and what belongs behind.
bool is_parameter_text(const Cursor& cursor);

/// Parameters by name (K=2 T=10 L=3 min), in the order of their kind (FOPDT 2 10 3), or lists of zeros and poles (zeros
/// -1, poles -2 -3±4i, gain 5), up to the end of the text:
///
///   text:    [kind] { name ["=" | ":"] value }       kind: fopdt, sopdt, ipdt or integrating; "," ";" between pairs
///   kind:    fopdt K T L, sopdt K T1 T2 L, ipdt K L [T] in brackets or without
///   names:   K, T, T1, T2, tau, L, theta, zeta, w0, zeros, poles, gain, delay and what else is usual for them
Plant read_parameters(Cursor& cursor, double own_time);

}  // namespace tunewright::typed
