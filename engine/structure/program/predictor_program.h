// What a predictor (predictor.h) computes in each call, as a program.
//
//   u = C [r - p],   p = Gm u + F (y - Gm e^(-Lm s) u)
//
// C is a PID with the rules, limits, anti-windup and manual of code/algorithm.h, and p its measurement. The model is
// exact for a u that is held between calls and for any dead time; its u is the one that limits have left. F is exact
// for a measurement that is held.
//
// The states of an integrating or unstable model would drift or grow. With its pole a, for which F(a) = e^(a Lm),
//
//   p = F y + Gm (1 - e^((a - s) Lm)) u + (e^(a Lm) - F) Gm e^(-Lm s) u
//
// in which the second term is the model's response to the u of the last dead time alone, begun at 0, and the last has
// no pole at a.
#pragma once

#include "engine/code/algorithm.h"
#include "engine/structure/predictor.h"

namespace tunewright::structure {

/// `law`: the rules and the sample time; its gains are those of predictor_pid(). All times in seconds. Errors:
/// unsupported for an integrating or unstable model whose pole F does not cancel ("controller/F"); invalid_argument
/// ("sample_time") for a dead time of more than kMaxDelayCalls calls; those of pid_algorithm().
Expected<code::Program> predictor_program(const PredictorController& controller, const SampledPid& law,
                                          const code::CodeOptions& u);

/// C as a PID: a proportional part, an integral part, and a derivative part with a filter. Error: unsupported
/// ("controller/C").
Expected<ParallelPid> predictor_pid(const PredictorController& controller);

}  // namespace tunewright::structure
