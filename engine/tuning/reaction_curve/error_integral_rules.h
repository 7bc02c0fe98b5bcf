// Settings fitted to optima of an error integral over L/T: one formula with many tables. The tables for load steps
// (Lopez, Miller, Smith and Murrill), for set-point steps (Rovira, Murrill and Smith; Wang, Juang and Chan) and for
// both (Zhuang and Atherton) are here.

#pragma once

#include <vector>

#include "engine/controller/pid.h"
#include "engine/reduction/reduction.h"
#include "engine/tuning/method/first_order_rule.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/method/option_set.h"

namespace tunewright {

/// Ti as a function of q = L/T.
enum class IntegralLaw {
    power,  ///< Ti = T q^b2/a2: fits to load steps
    line,   ///< Ti = T/(a2 + b2 q): fits to set-point steps
};

/// K Kp = a1 q^b1; Ti by the law, no integral action with a2 = 0; Td/T = a3 q^b3.
struct ErrorIntegralRow {
    double a1, b1, a2 = 0, b2 = 0, a3 = 0, b3 = 0;
};

/// `model`: first order, T > 0, L > 0.
IdealPid error_integral_settings(const ErrorIntegralRow& row, IntegralLaw law, const ReducedModel& model);

/// Integrals over time: ise of e^2, iae of |e|, itae of t |e|, itse of t e^2, iste and istse (the words of two sources)
/// of t^2 e^2.
enum class FittedCriterion { ise, iae, itae, itse, iste, istse };

const char* to_string(FittedCriterion criterion);

/// Option `criterion` with these choices.
template <class T>
void add_criterion(OptionSet<T>& set, const std::vector<FittedCriterion>& choices) {
    Words<FittedCriterion> words;
    for (const FittedCriterion choice : choices) words.emplace_back(to_string(choice), choice);
    set.choice(&T::criterion, "criterion", "The error integral for whose optima the settings were fitted.", words);
}

struct LopezOptions {
    ControllerKind controller = ControllerKind::PID;
    FittedCriterion criterion = FittedCriterion::iae;
    FirstOrderOptions model = {};
};

/// P, PI, PID with the least ISE, IAE or ITAE of a load step on a first-order model with dead time, for L/T from 0.1 to
/// 1:
///
///     Kp = a1 (L/T)^b1/K
///     Ti = T (L/T)^b2/a2
///     Td = a3 T (L/T)^b3
///
/// with the constants of the criterion from a table. The rule does not consider robustness: Ms is often above 2.
///
/// Source: Lopez, Miller, Smith & Murrill, Instrumentation Technology 14 (1967) 57-62, taken from textbooks that
/// contain its table.
TuningMethod lopez_method();

struct RoviraOptions {
    ControllerKind controller = ControllerKind::PID;
    FittedCriterion criterion = FittedCriterion::itae;
    FirstOrderOptions model = {};
};

/// PI and PID with the least IAE or ITAE of a set-point step on a first-order model with dead time, for L/T from 0.1 to
/// 1:
///
///     Kp = a1 (L/T)^b1/K
///     Ti = T/(a2 + b2 L/T)
///     Td = a3 T (L/T)^b3
///
/// with the constants of the criterion from a table.
///
/// Source: Rovira, Murrill & Smith, Instruments & Control Systems 42 (1969) 67-69, taken from textbooks that contain
/// its table.
TuningMethod rovira_method();

/// Kp = (0.7303 + 0.5307 T/L) (T + L/2)/(K (T + L)), Ti = T + L/2, Td = L T/(2 T + L): PID with the least ITAE of a
/// set-point step on a first-order model with dead time, Ti and Td those of an internal model controller; for L/T from
/// 0.05 to 6. Source: Wang, Juang & Chan, Chem. Eng. Communications 132 (1995) 15-34.
TuningMethod wang_juang_chan_method();

struct ZhuangAthertonOptions {
    ControllerKind controller = ControllerKind::PID;
    FittedCriterion criterion = FittedCriterion::iste;
    Mode mode = Mode::servo;
    FirstOrderOptions model = {};
};

/// PI and PID with the least integral of (t^n e)^2, n = 0 (ise) or 1 (iste), of a set-point (`mode` servo) or load step
/// (regulation) on a first-order model with dead time:
///
///     Kp = a1 (L/T)^b1/K
///     Ti = T/(a2 + b2 L/T) (servo), T (L/T)^b2/a2 (regulation)
///     Td = a3 T (L/T)^b3
///
/// Two tables, for L/T from 0.1 to 1 and from 1.1 to 2; between them the first is used up to 1, the second above. The
/// set-point PID was fitted with the derivative on the error; here it acts on the measurement.
///
/// Source: Zhuang & Atherton, IEE Proc. D 140 (1993) 216-224, Tables 1 to 4, taken from textbooks that contain them.
TuningMethod zhuang_atherton_method();

}  // namespace tunewright
