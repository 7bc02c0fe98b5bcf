// What an entry of the method emulation adds.
#pragma once

#include "api/describe/description.h"
#include "engine/tuning/emulation/emulation_report.h"

namespace tunewright::api {

const Description<EmulationReport>& emulation_contract();

}  // namespace tunewright::api
