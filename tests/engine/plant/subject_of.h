// A plant that is known to have no fault, as requests have it.
#pragma once

#include "engine/plant/subject.h"

namespace tunewright::test {

/// Throws std::bad_variant_access where the plant has a fault.
inline Subject subject_of(const PlantModel& plant) { return std::get<Subject>(Subject::make(plant)); }

}  // namespace tunewright::test
