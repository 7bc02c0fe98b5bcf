#include "api/report/html.h"

namespace tunewright::api {
namespace {

std::string escaped(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (const char c : text) {
        switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            case '\'': out += "&#39;"; break;
            default:
                if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
        }
    }
    return out;
}

std::string opening(const char* tag, Attributes attributes) {
    std::string out = std::string("<") + tag;
    for (const auto& [name, value] : attributes)
        if (!value.empty()) out += std::string(" ") + name + "=\"" + escaped(value) + "\"";
    return out;
}

}  // namespace

Html::Html(std::string_view text) : markup_(escaped(text)) {}

Html Html::trusted(std::string markup) {
    Html out;
    out.markup_ = std::move(markup);
    return out;
}

Html element(const char* tag, const Html& inside, Attributes attributes) {
    return Html::trusted(opening(tag, attributes) + ">" + inside.markup() + "</" + tag + ">");
}

Html empty_element(const char* tag, Attributes attributes) { return Html::trusted(opening(tag, attributes) + "/>"); }

}  // namespace tunewright::api
