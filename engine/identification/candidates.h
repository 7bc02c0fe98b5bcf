// The structures fitted to one record, and the choice among them.
#pragma once

#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/identify.h"
#include "engine/identification/output_error.h"

namespace tunewright {

/// Fits one structure: scan on the thinned record, refinement of the best starts there, final fit on the whole record.
/// `simpler` are fits of the structures that it contains; it never ends worse than they do. With no
/// u0 given, starts other than rest are fitted where the record asks for it, and kept if they lower the criterion
/// by 10.
Fit fit_structure(const CleanRecord& record, const CleanRecord& thin, Structure structure,
                  const std::vector<Fit>& simpler, std::stop_token stop);

/// n ln(sse/n) + p ln n (Schwarz 1978) with n the number of independent samples that the residuals are worth, in place
/// of their count: what a drift or a coarse grid leaves behind is not evidence for another time constant.
double information_criterion(const CleanRecord& record, const Fit& fit, double independent_samples);

struct Choice {
    int index = -1;  ///< into the fits; -1: none is determined
    std::string reason;
};

/// Among determined fits: the least criterion, unless a structure with fewer parameters comes within 2 of it; a zero
/// and an unstable pole must win by 10. `criteria` belong to `fits`; fit_percent only goes into the sentence.
Choice choose(const std::vector<Fit>& fits, const std::vector<double>& criteria, const std::vector<double>& fit_percent,
              double independent_samples);

/// The level of v at which y was at rest before the record; 0 for Start::at_rest.
double level_of_rest(const Fit& fit);

/// 100 (1 - ||residual||/||y - mean(y)||).
double fit_percent(const CleanRecord& record, const Fit& fit);

}  // namespace tunewright
