#include "api/contract/product/meant_product.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "api/describe/suggest.h"
#include "engine/controller/product/catalogue.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxMeant = 4;
constexpr std::size_t kMinLength = 3;  // of a text that is looked for inside names

/// Letters and digits alone, in lower case.
std::string bare(std::string_view text) {
    std::string out;
    for (const unsigned char c : text)
        if (std::isalnum(c) != 0) out += static_cast<char>(std::tolower(c));
    return out;
}

bool is_named(const product::Product& product, const std::string& word) {
    const auto holds = [&](std::string_view name) { return bare(name).find(word) != std::string::npos; };
    return holds(product.id) || holds(std::string(product.maker) + std::string(product.name)) ||
           std::ranges::any_of(product.families, holds);
}

}  // namespace

std::string meant_product(std::string_view id) {
    const std::string word = bare(id);
    std::vector<std::string> ids, meant;
    for (const product::Product& product : product::catalogue()) {
        ids.emplace_back(product.id);
        if (word.size() >= kMinLength && meant.size() < kMaxMeant && is_named(product, word))
            meant.push_back(ids.back());
    }
    if (meant.empty())
        if (const std::string near = nearest(id, ids); !near.empty()) meant.push_back(near);
    return meant.empty() ? "" : "Did you mean " + listed(meant) + "?";
}

}  // namespace tunewright::api
