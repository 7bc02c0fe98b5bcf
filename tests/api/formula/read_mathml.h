// MathML read back: a second reader, which shares nothing with the writers. What a formula says is compared with its
// text by the leaves, what it is worth by typing it out for the reader of the plants' equations.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tunewright::api {

struct Markup {
    std::string tag;   ///< empty: a text
    std::string text;  ///< of a text, entities resolved
    std::vector<Markup> inside;
};

/// A text without a root around it is one too. Throws std::runtime_error where the text is not well-formed: a tag that
/// is not closed, or an entity that is not known.
Markup read_markup(std::string_view text);

/// The texts of all leaves, one after another.
std::string leaves(const Markup& markup);

/// As it would be typed with every operator written: 2*(T_1+T_2)/(3*K*L). Greek letters by name, K_p for Kp.
std::string typed_out(const Markup& markup);

/// Greek letters and mathematical signs of a text by their names on a keyboard.
std::string on_a_keyboard(std::string text);

}  // namespace tunewright::api
