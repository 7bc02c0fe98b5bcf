// What was found, in the units of the record: the parts of an IdentifiedModel.
#pragma once

#include "engine/identification/fit/model_search.h"
#include "engine/identification/identify.h"
#include "engine/identification/relay_test/relay_fourier.h"

namespace tunewright {

/// Candidates sorted by criterion, the chosen one's figures, and the warnings that the fit gives rise to. `recorded`:
/// all samples, where the search had block means.
IdentifiedModel searched_model(ModelSearch search, const CleanRecord& recorded);

/// A model by formula: its free run from rest at `v_rest` beside the record, the offset estimated.
IdentifiedModel formula_model(const CleanRecord& record, const ModelShape& shape, double K, double v_rest);

/// G(sigma + j omega) of Eq. 9, sigma in 1/time.
struct Shift {
    double sigma = 0;
    std::complex<double> value;
};

/// The oscillation's figures, and the measured points of the frequency response: the first harmonic, and those others
/// that are known to a fifth.
void add_cycle(const CleanRecord& record, const RecordedCycle& cycle, const Shift& shift, IdentifiedModel& model);

/// Adds the band of frequencies that the record tells something about.
void add_excited_band(const CleanRecord& record, IdentifiedModel& model);

/// Adds the ultimate point of the model's plant.
void add_ultimate_point(IdentifiedModel& model);

}  // namespace tunewright
