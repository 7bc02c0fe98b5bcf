// Converts a product's settings to the equivalent controller of the ideal form.
#pragma once

#include <vector>

#include "engine/controller/product/settings.h"

namespace tunewright::product {

/// The ideal form that is exactly equivalent to the block's settings. Missing parameters have the maker's default if it
/// is known, else no integral, no derivative, no filter. Errors: invalid_argument at "settings/NAME" for a name or
/// value that the block does not accept; not_representable for gains that have no ideal form; as above for spans.
Expected<IdealPid> to_controller(const Product& product, const Settings& settings, const Context& context,
                                 std::vector<Note>& notes);

}  // namespace tunewright::product
