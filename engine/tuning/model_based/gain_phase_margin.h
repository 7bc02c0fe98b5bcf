// Ho, Hang and Cao's rules for a gain and a phase margin at once.
#pragma once

#include "engine/tuning/method/method.h"

namespace tunewright {

/// PI on a first-order, PID (series form, Td = T2, answered in the ideal form) on a second-order model with dead time,
/// for `gain_margin` and `phase_margin_deg`; the arctangents of the margins' equations are taken as straight lines, so
/// that both are met within some percent. Source: Ho, Hang & Cao, Automatica 31 (1995) 497-502.
TuningMethod gain_phase_margin_method();

}  // namespace tunewright
