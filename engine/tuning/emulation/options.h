// Options of the method emulation.
#pragma once

#include <vector>

#include "engine/tuning/method/options.h"

namespace tunewright::emulation {

std::vector<OptionDescription> described_options();

}  // namespace tunewright::emulation
