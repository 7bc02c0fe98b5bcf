// The decoupler of interacting loops in requests and answers of POST /v1/interaction.
#pragma once

#include "api/contract/structure/structure_parts.h"
#include "engine/structure/decoupling/decoupler.h"

namespace tunewright::api {

/// A decoupler, and what it does to the loops that it is part of.
struct DecouplingView {
    structure::Decoupler decoupler;
    Figure gain;  ///< cost without it over cost with it
    structure::WrongGains wrong;
};
const Description<DecouplingView>& decoupling_contract();

/// none, static or simplified.
Codec<structure::DecouplerKind> decoupler_kind();

}  // namespace tunewright::api
