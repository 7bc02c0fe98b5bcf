// Settings of a product by name: numbers, words and switches.
#pragma once

#include "api/describe/codec.h"
#include "engine/controller/product/product.h"

namespace tunewright::api {

/// An object; whether the names belong to the product is the product's to say.
Codec<product::Settings> settings_codec();

}  // namespace tunewright::api
