// The grammar of a plant that is typed as its parameters. The reader takes words from a cursor; if the cursor has
// failed, the result is meaningless. `own_time`: seconds of the unit of the resulting times; 0: unknown, units are
// refused.
#pragma once

#include "engine/plant/plant.h"
#include "engine/plant/typed/words.h"

namespace tunewright::typed {

/// True if a text consists of parameters: it begins with one of their names and its value.
bool is_parameter_text(const Cursor& cursor);

/// Parameters by name (K=2 T=10 L=3 min), in the order of their kind (FOPDT 2 10 3), or lists of zeros and poles (zeros
/// -1, poles -2 -3±4i, gain 5), up to the end of the text:
///
///   text:    [kind] { name ["=" | ":"] value }       kind: fopdt, sopdt, ipdt or integrating; "," ";" between pairs
///   kind:    fopdt K T L, sopdt K T1 T2 L, ipdt K L [T] in brackets or without
///   names:   K, T, T1, T2, tau, L, theta, zeta, w0, zeros, poles, gain, delay and usual synonyms
Plant read_parameters(Cursor& cursor, double own_time);

}  // namespace tunewright::typed
