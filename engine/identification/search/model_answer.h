// The result of the identification in the units of the record: the parts of an IdentifiedModel.
#pragma once

#include "engine/identification/identify.h"
#include "engine/identification/relay_test/relay_fourier.h"
#include "engine/identification/search/model_search.h"

namespace tunewright {

/// Candidates sorted by criterion, the chosen one's figures, and the warnings that result from the fit. `recorded`: all
/// samples, if the search used block means.
IdentifiedModel searched_model(ModelSearch search, const CleanRecord& recorded);

/// A model by formula: its free run from rest at `v_rest` for comparison with the record, with an estimated offset.
IdentifiedModel formula_model(const CleanRecord& record, const ModelShape& shape, double K, double v_rest);

/// G(sigma + j omega) of Eq. 9, sigma in 1/time.
struct Shift {
    double sigma = 0;
    std::complex<double> value;
};

/// The oscillation's figures, and the measured points of the frequency response: the first harmonic, and those others
/// whose error is below a fifth.
void add_cycle(const CleanRecord& record, const RecordedCycle& cycle, const Shift& shift, IdentifiedModel& model);

/// Adds the band of frequencies that the record excites.
void add_excited_band(const CleanRecord& record, IdentifiedModel& model);

/// Adds the ultimate point of the model's plant.
void add_ultimate_point(IdentifiedModel& model);

}  // namespace tunewright
