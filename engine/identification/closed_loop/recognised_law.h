// Recognises a controller by its law: u as P, PI or PID of the recorded y and set point, over the whole record.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u = constant - Kp y + Ki int (r - y) dt - Kd dy/dt + b r; dimensionless.
struct RecognisedLaw {
    double gain = 0;      ///< coefficient of y in the same row: -Kp
    double integral = 0;  ///< Ki
    double left = 0;      ///< share of u's variance that the law does not explain, 0 to 1
};

/// feedback.h decides which of u and y has new information from row to row. In a short or smooth record neither has,
/// because each is predicted by its own past. In such a record the law of a controller, four or five numbers for all
/// rows, is easy to recognise.
///
/// The law is that of controller_law/law_regression.h without filter and delay, each u off for itself (theta = 1). It
/// is found if it leaves less than a hundredth of u's variance and Kp and Ki have the same sign, unless u is a sine
/// (which any filter of a sine explains) or a lag after one step that explains u as well as the law does (a manual soft
/// start). Rows in manual, rows before u first moves and rows at an end of u's range are left out. Between them the
/// constant is free, as after a switch or a windup. A smooth test in manual may look the same, so the law must be
/// compared with how well u explains y.
///
/// At the samples: `u` is the input, dimensionless; `r` is the set point, dimensionless as y, or empty: then it is
/// assumed to be constant; `automatic` is 0 in manual, or empty. Empty for fewer than 40 rows in which u moves.
std::optional<RecognisedLaw> recognised_law(const CleanRecord& record, const std::vector<double>& u,
                                            const std::vector<double>& r, const std::vector<double>& automatic = {});

/// The share of y's variance that an unrestricted linear plant does not explain: by filters of u in earlier rows
/// (set_point_part.h).
double left_by_free_plant(const CleanRecord& record, const std::vector<double>& u);

}  // namespace tunewright
