// From the settings of a product to the controller of the ideal form that they are.
#pragma once

#include <vector>

#include "engine/controller/product/settings.h"

namespace tunewright::product {

/// The exact ideal twin of what stands in the block. Parameters that are missing have the maker's default where it is
/// known, else no integral, no derivative, no filter. Errors: invalid_argument at "settings/NAME" for a name or value
/// that the block does not take; not_representable for gains that have no ideal form; as above for spans.
Expected<IdealPid> to_controller(const Product& product, const Settings& settings, const Context& context,
                                 std::vector<Note>& notes);

}  // namespace tunewright::product
