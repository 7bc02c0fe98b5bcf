// Markup as a type of its own, so that text can only enter it escaped.
//
//   element("td", "a < b", {{"class", "name"}})     <td class="name">a &lt; b</td>
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace tunewright::api {

class Html {
public:
    Html() = default;
    /// Text, escaped. Characters that XML does not allow (control characters) are left out.
    Html(std::string_view text);                                     // NOLINT(google-explicit-constructor)
    Html(const char* text) : Html(std::string_view(text)) {}         // NOLINT(google-explicit-constructor)
    Html(const std::string& text) : Html(std::string_view(text)) {}  // NOLINT(google-explicit-constructor)

    /// Markup that this program has made, such as a formula.
    static Html trusted(std::string markup);

    Html& operator+=(const Html& more) {
        markup_ += more.markup_;
        return *this;
    }
    friend Html operator+(Html a, const Html& b) { return a += b; }

    bool empty() const { return markup_.empty(); }
    const std::string& markup() const { return markup_; }

private:
    std::string markup_;
};

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

/// Attributes' values are escaped; an empty one is left out.
Html element(const char* tag, const Html& inside, Attributes attributes = {});
/// An element without content, of SVG or HTML: <path .../>, <br/>.
Html empty_element(const char* tag, Attributes attributes = {});

}  // namespace tunewright::api
