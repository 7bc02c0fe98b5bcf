// A product's snippets with the settings in them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/controller/product/settings.h"

namespace tunewright::product {

struct FilledSnippet {
    std::string_view name;  ///< of the catalogue
    std::string text;       ///< lines without a line break at the end
};

/// The product's snippets (product.h) with these settings, as they are typed, and the period of `context`, or else the
/// block's default. A snippet without any line left is omitted.
std::vector<FilledSnippet> filled_snippets(const Product& product, const Settings& typed, const Context& context);

}  // namespace tunewright::product
