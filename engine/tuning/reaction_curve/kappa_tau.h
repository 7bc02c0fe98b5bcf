// The Kappa-tau rules for step-response models.
#pragma once

#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {

enum class TableMs { Ms_1_4, Ms_2_0 };

struct KappaTauOptions {
    ControllerKind controller = ControllerKind::PID;
    TableMs table_Ms = TableMs::Ms_1_4;  ///< the Ms for which the table was fitted
    FirstOrderOptions model = {};
};

/// PI and PID in tau = L/(L + T), fitted to designs by dominant poles with Ms of 1.4 or 2 (`table_Ms`) over a batch of
/// plants:
///
///     a Kp, Ti/L, Td/L, b = a0 exp(a1 tau + a2 tau^2),   a = K L/T
///
/// with a0, a1, a2 of each from a table. A b above 1 becomes 1. The ranges of L/T are not from the source: on a
/// first-order plant the loop with the PID is unstable below about 0.2.
///
/// Errors: those of tune_first_order(). Warns `outside-validity` for L/T outside 0.1 to 4, with PID outside 0.4 to 4.
///
/// Source: Åström & Hägglund, PID Controllers: Theory, Design, and Tuning (1995), section 5.3, tables for stable
/// processes.
TuningMethod kappa_tau_method();

}  // namespace tunewright
