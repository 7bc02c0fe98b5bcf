// A reader of MathML that shares no code with the writers. The leaves of a formula are compared with its text; its
// value is computed by writing it out for the parser of the plants' equations.
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

/// A text without a root around it is one too. Throws std::runtime_error if the text is not well-formed: a tag that is
/// not closed, or an entity that is not known.
Markup read_markup(std::string_view text);

/// The texts of all leaves, one after another.
std::string leaves(const Markup& markup);

/// The formula as typed, with every operator written: 2*(T_1+T_2)/(3*K*L). Greek letters by name, K_p for Kp.
std::string typed_out(const Markup& markup);

/// Replaces Greek letters and mathematical signs of a text by their names.
std::string on_a_keyboard(std::string text);

}  // namespace tunewright::api
